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
/// are built together, for cargo builds what packages share anew for each set of
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

fn is_cargo(command: &Command) -> bool {
    let names_packages = |arg: &String| arg == "--package" || arg == "-p";
    command.program == "cargo"
        && command.args.first().is_some_and(|first| first == "build")
        && command.args.iter().any(names_packages)
}
