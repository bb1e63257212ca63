//! Any file as a rosbag2 bag in SQLite: reading any part of it never panics.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use recording::Recording;

static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
    // Kept until the end of the process, which is the end of the run.
    tempfile::tempdir().unwrap().keep().join("a.db3")
});

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(&*FILE, bytes).unwrap();
    let Ok(recording) = Recording::open(&*FILE) else {
        return;
    };
    let _ = recording.damage_error();
    let _ = recording.ground_truths();
    for record in recording.records() {
        let _ = record;
    }
});
