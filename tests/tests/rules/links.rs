//! Links between crates: nodes never link each other, and some crates must stay free of others.

use std::collections::BTreeSet;

use crate::workspace::{dependencies, folders};

/// The only nodes that may link Zenoh, directly or by `zenoh_session`: the others must build in a
/// minute.
const ZENOH_NODES: [&str; 4] = ["bridge", "fleet_monitor", "locate_server", "ros2_gateway"];

pub(crate) fn links_zenoh(dependencies: &BTreeSet<String>) -> bool {
    let is_zenoh = |name: &String| name.starts_with("zenoh") || name == "zenoh_session";
    dependencies.iter().any(is_zenoh)
}

#[test]
fn nodes_never_depend_on_nodes() {
    let nodes = folders("nodes");
    for (name, dependencies) in dependencies() {
        let on_nodes: Vec<_> = dependencies.intersection(&nodes).collect();
        assert!(on_nodes.is_empty(), "{name} depends on {on_nodes:?}");
    }
}

#[test]
fn each_crate_has_the_name_of_its_folder() {
    let names: BTreeSet<String> = dependencies().into_keys().collect();
    let folders: BTreeSet<String> = folders("nodes")
        .into_iter()
        .chain(folders("common"))
        .collect();
    let tests = BTreeSet::from(["soak".to_owned(), "tests".to_owned()]);
    assert_eq!(
        names.difference(&folders).cloned().collect::<BTreeSet<_>>(),
        tests
    );
    assert_eq!(folders.difference(&names).count(), 0);
}

#[test]
fn what_takes_long_to_build_is_linked_only_where_it_is_needed() {
    for (name, dependencies) in dependencies() {
        let is_among = |names: &[&str]| names.contains(&name.as_str());
        let has = |library: &str| dependencies.contains(library);
        // It joins machines.
        let may = is_among(&ZENOH_NODES) || name == "zenoh_session";
        assert!(may || !links_zenoh(&dependencies), "{name}");
        let may = name == "foxglove_server";
        assert!(may || !has("foxglove"), "{name}");
        // A runtime for what is asked over a network. Foxglove's server runs on the runtime that
        // its node gives it.
        let others = ["dashboard", "foxglove_server", "shared_features", "tests"];
        let may = is_among(&ZENOH_NODES) || is_among(&others);
        assert!(may || !has("tokio") && !has("axum"), "{name}");
    }
}
