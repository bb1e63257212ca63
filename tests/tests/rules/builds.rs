//! Crates that are built together, and that they are built only once.

use std::collections::BTreeSet;
use std::process::Command;

use crate::links::links_zenoh;
use crate::workspace::{dependencies, folders, metadata};

/// True if it takes longer to build than the nodes of a graph on one machine.
fn takes_long(dependencies: &BTreeSet<String>) -> bool {
    links_zenoh(dependencies) || dependencies.contains("foxglove")
}

#[test]
fn the_first_command_builds_every_node_but_those_that_take_long() {
    let metadata = metadata();
    let members = metadata["workspace_default_members"].as_array().unwrap();
    let built: BTreeSet<_> = members
        .iter()
        .map(|id| {
            let (path, _) = id.as_str().unwrap().split_once('#').unwrap();
            path.rsplit('/').next().unwrap().to_owned()
        })
        .collect();
    let dependencies = dependencies();
    let expected: BTreeSet<_> = folders("nodes")
        .into_iter()
        .filter(|node| !takes_long(&dependencies[node]))
        .collect();
    let nodes = built.into_iter().filter(|name| name != "shared_features");
    assert_eq!(nodes.collect::<BTreeSet<_>>(), expected);
}

/// Returns each dependency with its features, as a line, in the build that the options choose.
fn features(options: &[&str]) -> BTreeSet<String> {
    let mut command = Command::new(env!("CARGO"));
    command.args(["tree", "--locked", "--prefix", "none", "--no-dedupe"]);
    command.args(["--format", "{p} {f}"]).args(options);
    let text = tests::text_of(command.current_dir(tests::root()));
    text.lines().map(str::to_owned).collect()
}

/// Returns the names of the dependencies in the build that the options choose.
pub(crate) fn names(options: &[&str]) -> BTreeSet<String> {
    let lines = features(options);
    let names = lines.iter().filter_map(|line| line.split(' ').next());
    names.map(str::to_owned).collect()
}

/// Otherwise each of the three compiles its own iceoryx2 and tokio, which takes minutes.
#[test]
fn a_run_what_it_starts_and_the_tests_use_the_same_dependencies() {
    let run = features(&["-p", "backcast", "--edges", "no-dev"]);
    let started = features(&["--edges", "no-dev"]);
    let tests = features(&["--workspace"]);
    assert!(run.len() > 200, "{run:?}");
    let differs: Vec<_> = run
        .union(&started)
        .filter(|line| !tests.contains(*line))
        .collect();
    assert!(
        differs.is_empty(),
        "in a build of the workspace these have other features, \
         to be listed in common/shared_features/Cargo.toml: {differs:#?}"
    );
}

/// A robot that runs a graph needs neither the tools nor the crates they link.
#[test]
fn the_launcher_alone_links_nothing_of_the_tools() {
    let names =
        |options: &[&str]| names(&[&["-p", "backcast", "--edges", "no-dev"], options].concat());
    let of_tools = "bench evaluation indicatif offline plots quick-junit ratatui recording \
                    recording_tools resvg rusqlite serialport simulation tungstenite";
    let of_tools: BTreeSet<String> = of_tools.split(' ').map(str::to_owned).collect();
    let (alone, with_tools) = (names(&["--no-default-features"]), names(&[]));
    assert!(alone.contains("launcher"), "{alone:?}");
    let missing: Vec<_> = of_tools.difference(&with_tools).collect();
    assert!(missing.is_empty(), "the tools do not link {missing:?}");
    let linked: Vec<_> = alone.intersection(&of_tools).collect();
    assert!(linked.is_empty(), "the launcher links {linked:?}");
}
