//! Helpers for our nodes that are added to a graph without being in its descriptor.

use dataflow::{Command, Dataflow};

/// Returns the path of `executable` in the folder of the graph's first executable.
pub(crate) fn path(dataflow: &Dataflow, executable: &str) -> String {
    let folder = dataflow
        .nodes
        .iter()
        .find_map(|node| node.path.rsplit_once('/'));
    folder.map_or(executable.to_owned(), |(folder, _)| {
        format!("{folder}/{executable}")
    })
}

/// Returns the build command of the first node that cargo builds, extended by `executable`. All
/// nodes with that command get the extended one, because cargo may rebuild shared dependencies for
/// each set of packages that is built together.
pub(crate) fn build(dataflow: &mut Dataflow, executable: &str) -> Vec<Command> {
    let Some(like) = dataflow.nodes.iter().find(|n| n.build.iter().any(is_cargo)) else {
        return Vec::new();
    };
    let before = like.build.clone();
    let mut build = before.clone();
    for command in build.iter_mut().filter(|command| is_cargo(command)) {
        command
            .args
            .extend(["--package", executable].map(str::to_owned));
    }
    for node in dataflow
        .nodes
        .iter_mut()
        .filter(|node| node.build == before)
    {
        node.build.clone_from(&build);
    }
    build
}

/// Returns the first cargo build command with `executable` as its only package: for an executable
/// that takes long to build and is not built with the others.
pub(crate) fn build_alone(dataflow: &Dataflow, executable: &str) -> Vec<Command> {
    let is_build = |command: &&Command| {
        command.program == "cargo" && command.args.first().is_some_and(|first| first == "build")
    };
    let like = dataflow.nodes.iter().flat_map(|node| &node.build);
    let Some(mut build) = like.clone().find(is_build).cloned() else {
        return Vec::new();
    };
    let mut names_package = false;
    build.args.retain(|arg| {
        let is_name = std::mem::take(&mut names_package);
        names_package = arg == "--package" || arg == "-p";
        !is_name && !names_package
    });
    let package = ["--package", executable].map(str::to_owned);
    build.args.extend(package);
    vec![build]
}

fn is_cargo(command: &Command) -> bool {
    let names_packages = |arg: &String| arg == "--package" || arg == "-p";
    command.program == "cargo"
        && command.args.first().is_some_and(|first| first == "build")
        && command.args.iter().any(names_packages)
}
