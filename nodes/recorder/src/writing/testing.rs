//! Messages for the tests of files.

use recording::Recording;
use recording::write::Encoded;
use ros_graph::export::Entry;

pub(super) const SECOND: i64 = 1_000_000_000;

/// A message of incompressible bytes, so that a file grows by about as much.
pub(super) fn message(topic: &'static str, second: i64, latched: bool) -> Entry {
    let byte = |i: u32| (i.wrapping_mul(2_654_435_761) >> 13) as u8;
    Entry::Message(Encoded {
        topic: topic.into(),
        schema: "n",
        definition: "int64 n",
        latched,
        log_time_ns: second * SECOND,
        body: (0..2000).map(byte).collect(),
    })
}

pub(super) fn topics(recording: &Recording) -> Vec<(String, i64)> {
    let records = recording.raw_records().map(Result::unwrap);
    records
        .map(|r| (r.channel.topic.to_string(), r.log_time_ns / SECOND))
        .collect()
}
