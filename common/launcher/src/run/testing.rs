//! Helper shared by the tests of several files.

use dataflow::Dataflow;

pub(crate) fn parsed(text: &str) -> Dataflow {
    let topics = dataflow::Topics {
        names: messages::topic::NAMES,
        shared: &[],
        several: &[],
    };
    dataflow::parse(text, &topics).unwrap()
}
