//! Any text as a graph's descriptor: nothing panics.
#![no_main]

use dataflow::Topics;
use libfuzzer_sys::fuzz_target;

const TOPICS: Topics = Topics {
    names: &["scan", "map", "votes"],
    shared: &["health"],
    several: &["scan"],
};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(text) = std::str::from_utf8(bytes) {
        let _ = dataflow::parse(text, &TOPICS);
    }
});
