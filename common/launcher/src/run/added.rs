//! Helpers for our nodes that are added to a graph without being in its descriptor.

use command_line::wrong_use;
use dataflow::{Command, Dataflow, Node, Place, Restart};

/// Creates a node of the executable `id` next to those of the graph, without arguments and wires.
pub(crate) fn node(dataflow: &Dataflow, id: &str, build: Vec<Command>) -> Node {
    Node {
        id: id.to_owned(),
        path: path(dataflow, id),
        path_place: Place::START,
        args: Vec::new(),
        env: Vec::new(),
        build,
        inputs: Vec::new(),
        outputs: Vec::new(),
        streams: Vec::new(),
        restart: Restart::ON_FAILURE,
    }
}

pub(crate) fn check_new(dataflow: &Dataflow, option: &str, id: &str) -> anyhow::Result<()> {
    let is_same = |node: &Node| node.id == id || node.executable() == id;
    if dataflow.nodes.iter().any(is_same) {
        return Err(wrong_use(format!(
            "{option} adds a node `{id}`, but the graph has one already"
        )));
    }
    Ok(())
}

fn path(dataflow: &Dataflow, executable: &str) -> String {
    let mut nodes = dataflow.nodes.iter();
    match nodes.find_map(|node| node.path.rsplit_once('/')) {
        Some((folder, _)) => format!("{folder}/{executable}"),
        None => executable.to_owned(),
    }
}

/// Returns the first cargo build command extended by `executable`, as cargo may rebuild shared
/// dependencies for each set of packages.
pub(crate) fn build(dataflow: &mut Dataflow, executable: &str) -> Vec<Command> {
    let Some(like) = dataflow.nodes.iter().find(|n| n.build.iter().any(is_cargo)) else {
        return Vec::new();
    };
    let before = like.build.clone();
    let mut build = before.clone();
    let package = ["--package", executable].map(str::to_owned);
    for command in build.iter_mut().filter(|command| is_cargo(command)) {
        command.args.extend(package.clone());
    }
    let nodes = dataflow.nodes.iter_mut();
    for node in nodes.filter(|node| node.build == before) {
        node.build.clone_from(&build);
    }
    build
}

/// Returns the first cargo build command with `executable` as its only package.
pub(crate) fn build_alone(dataflow: &Dataflow, executable: &str) -> Vec<Command> {
    let like = dataflow.nodes.iter().flat_map(|node| &node.build);
    let Some(mut build) = like.clone().find(|command| is_build(command)).cloned() else {
        return Vec::new();
    };
    let mut is_before_name = false;
    build.args.retain(|arg| {
        let is_name = std::mem::replace(&mut is_before_name, names_package(arg));
        !is_name && !is_before_name
    });
    let package = ["--package", executable].map(str::to_owned);
    build.args.extend(package);
    vec![build]
}

fn is_build(command: &Command) -> bool {
    command.program == "cargo" && command.args.first().is_some_and(|first| first == "build")
}

fn is_cargo(command: &Command) -> bool {
    is_build(command) && command.args.iter().any(names_package)
}

fn names_package(arg: &String) -> bool {
    arg == "--package" || arg == "-p"
}
