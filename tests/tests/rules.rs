//! Rules of the workspace that the compiler does not keep.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use syn::visit::Visit;
use syn::{ItemUse, UseTree};

/// The only nodes that may link zenoh, by themselves or with `zenoh_session`: the others
/// must build in a minute.
const ZENOH_NODES: [&str; 4] = ["bridge", "fleet_monitor", "locate_server", "ros2_gateway"];

/// What cargo knows of the workspace.
fn metadata() -> Value {
    let options = ["metadata", "--format-version", "1", "--no-deps", "--locked"];
    let mut command = Command::new(env!("CARGO"));
    tests::json_of(command.args(options).current_dir(tests::root()))
}

/// The workspace's crates, each with the names of what it links; what only its
/// tests use does not count.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let metadata = metadata();
    let name = |value: &Value| folder_of(value["name"].as_str().unwrap()).to_owned();
    let linked = |package: &Value| {
        let all = package["dependencies"].as_array().unwrap().iter();
        all.filter(|dependency| dependency["kind"].is_null())
            .map(name)
            .collect()
    };
    let packages = metadata["packages"].as_array().unwrap().iter();
    packages
        .map(|package| (name(package), linked(package)))
        .collect()
}

/// What others may use has a name of its own on crates.io.
fn folder_of(package: &str) -> &str {
    package.strip_prefix("backcast-").unwrap_or(package)
}

fn folders(parent: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(tests::root().join(parent)).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

fn links_zenoh(dependencies: &BTreeSet<String>) -> bool {
    let is_zenoh = |name: &String| name.starts_with("zenoh") || name == "zenoh_session";
    dependencies.iter().any(is_zenoh)
}

/// Whether it builds longer than the nodes of a graph on one machine.
fn takes_long(dependencies: &BTreeSet<String>) -> bool {
    links_zenoh(dependencies) || dependencies.contains("foxglove")
}

/// All files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                files(&path)
            } else {
                vec![path]
            }
        })
        .collect()
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
fn the_engine_knows_no_process_socket_clock_or_file() {
    let allowed = BTreeSet::from(["geometry", "messages"].map(str::to_owned));
    assert_eq!(known("engine"), allowed);
    is_pure("common/engine/src");
}

#[test]
fn the_codecs_of_lasers_know_no_socket_clock_or_file_and_nothing_of_ours() {
    assert_eq!(known("sick"), BTreeSet::new());
    is_pure("common/sick/src");
}

#[test]
fn the_simulation_knows_no_engine_process_clock_or_file() {
    let allowed = BTreeSet::from(["geometry", "map"].map(str::to_owned));
    assert_eq!(known("simulation"), allowed);
    is_pure("common/simulation/src");
}

#[test]
fn messages_of_ros_know_no_process_socket_clock_or_file() {
    let allowed = BTreeSet::from(["geometry", "map", "messages"].map(str::to_owned));
    assert_eq!(known("ros"), allowed);
    is_pure("common/ros/src");
}

#[test]
fn foxglove_is_linked_by_its_server_alone() {
    for (name, dependencies) in dependencies() {
        let may = name == "foxglove_server";
        assert!(may || !dependencies.contains("foxglove"), "{name}");
    }
}

#[test]
fn what_crosses_a_network_is_read_without_one() {
    assert_eq!(
        known("network_payload"),
        BTreeSet::from(["messages".to_owned()])
    );
    is_pure("common/network_payload/src");
}

/// The crates under `common` that this one links.
fn known(name: &str) -> BTreeSet<String> {
    let all = folders("common");
    dependencies()[name].intersection(&all).cloned().collect()
}

/// Modules of the standard library that reach outside a function's arguments.
const IMPURE: [&str; 6] = ["env", "fs", "io", "net", "process", "time"];

fn is_pure(folder: &str) {
    let sources = files(&tests::root().join(folder));
    assert!(!sources.is_empty(), "{folder} has no sources");
    for file in sources {
        let used = paths_in(&std::fs::read_to_string(&file).unwrap());
        let impure: Vec<_> = used.iter().filter(|path| is_impure(path)).collect();
        assert!(impure.is_empty(), "{} uses {impure:?}", file.display());
    }
}

fn is_impure(path: &str) -> bool {
    let module = path.strip_prefix("std::").unwrap_or_default();
    let module = module.split("::").next().unwrap_or_default();
    module == "*" || IMPURE.contains(&module)
}

/// Every path that a source names, imports in groups one by one.
fn paths_in(source: &str) -> BTreeSet<String> {
    let mut paths = Paths::default();
    paths.visit_file(&syn::parse_file(source).unwrap());
    paths.0
}

#[derive(Default)]
struct Paths(BTreeSet<String>);

impl Paths {
    fn import(&mut self, before: &str, tree: &UseTree) {
        let below = |name: &dyn std::fmt::Display| match before {
            "" => name.to_string(),
            _ => format!("{before}::{name}"),
        };
        match tree {
            UseTree::Path(path) => self.import(&below(&path.ident), &path.tree),
            UseTree::Name(name) => _ = self.0.insert(below(&name.ident)),
            UseTree::Rename(name) => _ = self.0.insert(below(&name.ident)),
            UseTree::Glob(_) => _ = self.0.insert(below(&"*")),
            UseTree::Group(group) => {
                let trees = group.items.iter();
                trees.for_each(|tree| self.import(before, tree));
            }
        }
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.import("", &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|part| part.ident.to_string());
        self.0.insert(names.collect::<Vec<_>>().join("::"));
        syn::visit::visit_path(self, path);
    }
}

#[test]
fn paths_are_found_however_they_are_written() {
    let source = "use std::{fmt, fs::{self, File}, io as outside};\nfn f() { ::std::env::args(); }";
    let found = paths_in(source);
    let impure: Vec<_> = found.iter().filter(|path| is_impure(path)).collect();
    let expected = [
        "std::env::args",
        "std::fs::File",
        "std::fs::self",
        "std::io",
    ];
    assert_eq!(impure, expected);
    assert!(is_impure("std::*") && !is_impure("std::iter::from_fn"));
    assert!(!is_impure("outside::fs"));
}

#[test]
fn every_dependency_is_used() {
    // Its dependencies are there for their features.
    const FEATURES: &str = "shared_features";
    let metadata = metadata();
    for package in metadata["packages"].as_array().unwrap() {
        let name = package["name"].as_str().unwrap();
        if name == FEATURES {
            continue;
        }
        let manifest = Path::new(package["manifest_path"].as_str().unwrap());
        let sources = files(manifest.parent().unwrap()).into_iter();
        let sources = sources.filter(|file| file.extension().is_some_and(|ending| ending == "rs"));
        let text: String = sources
            .map(|file| std::fs::read_to_string(file).unwrap())
            .collect();
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let words: BTreeSet<&str> = text.split(|c| !is_name(c)).collect();
        for dependency in package["dependencies"].as_array().unwrap() {
            let renamed = dependency["rename"].as_str();
            let dependency = renamed.unwrap_or_else(|| dependency["name"].as_str().unwrap());
            let is_used = words.contains(dependency.replace('-', "_").as_str());
            assert!(
                is_used || dependency == FEATURES,
                "{name} does not use {dependency}"
            );
        }
    }
}

/// What a program links that uses the engine as a library.
#[test]
fn the_engine_as_a_library_brings_no_command_line_and_no_shared_memory() {
    let options = [
        "--edges", "normal", "--prefix", "none", "--format", "{p}", "--locked",
    ];
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--package", "backcast-engine"])
        .args(options);
    let output = tree.current_dir(tests::root()).output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout).unwrap();
    let names: BTreeSet<&str> = text
        .lines()
        .filter_map(|line| line.split(' ').next())
        .collect();
    assert!(
        names.contains("backcast-engine") && names.contains("nalgebra"),
        "{text}"
    );
    let foreign = names
        .iter()
        .filter(|name| name.starts_with("clap") || name.starts_with("iceoryx2"));
    assert_eq!(foreign.collect::<Vec<_>>(), Vec::<&&str>::new());
}

#[test]
fn drawing_knows_no_other_crate_of_the_project() {
    let dependencies = dependencies();
    let known: Vec<_> = dependencies["drawing"]
        .iter()
        .filter(|name| dependencies.contains_key(*name))
        .collect();
    assert!(known.is_empty(), "drawing depends on {known:?}");
}

#[test]
fn each_crate_has_the_name_of_its_folder() {
    let names: BTreeSet<String> = dependencies().into_keys().collect();
    let folders: BTreeSet<String> = folders("nodes")
        .into_iter()
        .chain(folders("common"))
        .collect();
    let tests = BTreeSet::from(["tests".to_owned()]);
    assert_eq!(
        names.difference(&folders).cloned().collect::<BTreeSet<_>>(),
        tests
    );
    assert_eq!(folders.difference(&names).count(), 0);
}

#[test]
fn zenoh_is_linked_only_where_machines_are_joined() {
    for (name, dependencies) in dependencies() {
        let may = ZENOH_NODES.contains(&name.as_str()) || name == "zenoh_session";
        assert!(may || !links_zenoh(&dependencies), "{name}");
    }
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

/// Each dependency with its features, as a line, in the build that the options choose.
fn features(options: &[&str]) -> BTreeSet<String> {
    let mut command = Command::new(env!("CARGO"));
    command.args(["tree", "--locked", "--prefix", "none", "--no-dedupe"]);
    command.args(["--format", "{p} {f}"]).args(options);
    let output = command.current_dir(tests::root()).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(str::to_owned).collect()
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

/// A robot that runs a graph needs none of the tools, nor what they link.
#[test]
fn the_launcher_alone_links_nothing_of_the_tools() {
    let names = |options: &[&str]| -> BTreeSet<String> {
        let lines = features(&[&["-p", "backcast", "--edges", "no-dev"], options].concat());
        let names = lines.iter().filter_map(|line| line.split(' ').next());
        names.map(str::to_owned).collect()
    };
    let of_tools = [
        "bench",
        "benchmarks",
        "drawing",
        "evaluation",
        "indicatif",
        "offline",
        "plots",
        "probe",
        "quick-junit",
        "ratatui",
        "recording",
        "recording_tools",
        "regression",
        "rusqlite",
        "serialport",
        "simulation",
        "soak",
        "tiny-skia",
        "top",
        "tungstenite",
    ];
    let of_tools = BTreeSet::from(of_tools.map(str::to_owned));
    let (alone, with_tools) = (names(&["--no-default-features"]), names(&[]));
    assert!(alone.contains("launcher"), "{alone:?}");
    let missing: Vec<_> = of_tools.difference(&with_tools).collect();
    assert!(missing.is_empty(), "the tools do not link {missing:?}");
    let linked: Vec<_> = alone.intersection(&of_tools).collect();
    assert!(linked.is_empty(), "the launcher links {linked:?}");
}

#[test]
fn only_what_is_asked_over_a_network_has_a_runtime_for_it() {
    for (name, dependencies) in dependencies() {
        // Foxglove's server runs on the runtime that its node gives it.
        let others = ["dashboard", "foxglove_server", "shared_features", "tests"];
        let may = ZENOH_NODES.contains(&name.as_str()) || others.contains(&name.as_str());
        for library in ["tokio", "axum"] {
            assert!(
                may || !dependencies.contains(library),
                "{name} links {library}"
            );
        }
    }
}
