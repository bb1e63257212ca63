//! Any file as an MCAP recording: reading any part of it never panics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use recording::Recording;

fuzz_target!(|bytes: &[u8]| {
    let Ok(recording) = Recording::from_bytes("fuzzed.mcap", bytes.to_vec()) else {
        return;
    };
    let _ = recording.damage_error();
    let _ = recording.ground_truths();
    for record in recording.records() {
        let _ = record;
    }
    for record in recording.raw_records() {
        let _ = record;
    }
});
