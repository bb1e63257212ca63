//! A graph that belongs to one test.

use transport::{Graph, GraphName, remove_leftovers};

/// A name that no other test and no other run uses; what the graph leaves is
/// removed in the end. To be dropped after everything in the graph.
pub(crate) struct Isolated {
    name: GraphName,
}

impl Isolated {
    /// `tag` tells the tests of this executable apart, in at most 11 bytes.
    pub(crate) fn new(tag: &str) -> Self {
        let name = GraphName::new(&format!("t{}-{tag}", std::process::id())).unwrap();
        Isolated { name }
    }

    pub(crate) fn join(&self, node: &str) -> Graph {
        Graph::join_named(node, &self.name).unwrap()
    }
}

impl Drop for Isolated {
    fn drop(&mut self) {
        let outcome = remove_leftovers(&self.name);
        if !std::thread::panicking() {
            outcome.unwrap();
        }
    }
}
