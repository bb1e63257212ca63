//! Any text as a CARMEN laser log, converted to a recording: nothing panics, and the recording can
//! be read.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use clap::Parser;
use libfuzzer_sys::fuzz_target;
use recording::Recording;
use recording_tools::convert;

#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    config: convert::Config,
}

static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    // Kept until the end of the process, which is the end of the run.
    tempfile::tempdir().unwrap().keep()
});

fuzz_target!(|bytes: &[u8]| {
    let (log, recording) = (FOLDER.join("a.log"), FOLDER.join("a.mcap"));
    std::fs::write(&log, bytes).unwrap();
    // Left by the previous iteration, if its conversion succeeded.
    let _ = std::fs::remove_file(&recording);
    let arguments = [PathBuf::from("convert"), log, recording.clone()];
    let arguments = Arguments::parse_from(arguments);
    if convert::run(&arguments.config).is_err() {
        assert!(!recording.exists(), "a failed conversion leaves no file");
        return;
    }
    let written = Recording::open(&recording).unwrap();
    assert!(written.records().all(|record| record.is_ok()));
});
