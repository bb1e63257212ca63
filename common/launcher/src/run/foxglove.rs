//! `--foxglove`: adds a server for viewers to a graph.
//!
//! Its executable is next to those of the graph. It subscribes to every topic by itself and needs
//! no wires; no node waits for it.

use dataflow::{Dataflow, Node, Place, Restart};

use super::added;
use crate::LauncherError;

const SERVER: &str = "foxglove_server";

/// Adds the server to the graph.
///
/// # Errors
/// The graph has such a server already.
pub(crate) fn add(dataflow: &mut Dataflow) -> Result<(), LauncherError> {
    let is_server = |node: &Node| node.id == SERVER || node.executable() == SERVER;
    if dataflow.nodes.iter().any(is_server) {
        let problem = "--foxglove adds a node `foxglove_server`, but the graph has one already";
        return Err(LauncherError::Usage(problem.to_owned()));
    }
    let node = Node {
        id: SERVER.to_owned(),
        path: added::path(dataflow, SERVER),
        path_place: Place::START,
        args: Vec::new(),
        env: Vec::new(),
        build: added::build_alone(dataflow, SERVER),
        inputs: Vec::new(),
        outputs: Vec::new(),
        streams: Vec::new(),
        // Viewers reconnect by themselves.
        restart: Restart::ON_FAILURE,
    };
    dataflow.nodes.push(node);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn added_to(nodes: &str) -> Result<Node, LauncherError> {
        let text = format!("nodes: [{nodes}]");
        let topics = dataflow::Topics::default();
        let mut dataflow = dataflow::parse(&text, &topics).unwrap();
        add(&mut dataflow)?;
        Ok(dataflow.nodes.pop().unwrap())
    }

    #[test]
    fn the_server_is_built_by_itself_where_cargo_builds_the_others() {
        for build in [
            "cargo build --release",
            "cargo build --package a -p b --release",
        ] {
            let node = added_to(&format!("{{id: a, path: bin/a, build: {build}}}")).unwrap();
            assert_eq!((&*node.id, &*node.path), (SERVER, "bin/foxglove_server"));
            let built = node.build[0].to_string();
            assert_eq!(built, "cargo build --release --package foxglove_server");
        }
        let node = added_to("{id: a, path: bin/a, build: make}").unwrap();
        assert!(node.build.is_empty());
    }

    #[test]
    fn a_server_that_is_there_stays_alone() {
        let error = added_to("{id: x, path: bin/foxglove_server}").unwrap_err();
        assert!(error.to_string().contains("has one already"), "{error}");
    }
}
