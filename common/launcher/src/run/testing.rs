//! Helper shared by the tests of several files.

use dataflow::Dataflow;

/// Parses a descriptor with the topics of the graph.
pub(crate) fn parsed(text: &str) -> Dataflow {
    let topics = dataflow::Topics {
        names: messages::topic::NAMES,
        shared: &[],
        several: &[],
    };
    dataflow::parse(text, &topics).unwrap()
}
