//! What the tests of several files need.

use dataflow::Dataflow;

/// A descriptor whose topics are those of the graph.
pub(super) fn parsed(text: &str) -> Dataflow {
    let topics = dataflow::Topics {
        names: messages::topic::NAMES,
        shared: &[],
        several: &[],
    };
    dataflow::parse(text, &topics).unwrap()
}
