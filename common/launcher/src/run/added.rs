//! Nodes of ours that are added to a graph, which its descriptor does not name.

use dataflow::{Command, Dataflow};

/// Beside the first executable of the graph.
pub(crate) fn path(dataflow: &Dataflow, executable: &str) -> String {
    let folder = dataflow
        .nodes
        .iter()
        .find_map(|node| node.path.rsplit_once('/'));
    folder.map_or(executable.to_owned(), |(folder, _)| {
        format!("{folder}/{executable}")
    })
}

/// As the first node is built, if cargo builds it. It joins the packages that
/// are built together, for cargo builds what packages share again for each set of
/// packages that share it differently.
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

/// As the first node that cargo builds, but alone: for what takes long to build and is
/// not among the packages that are built together.
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
