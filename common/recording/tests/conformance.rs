//! The published suite of the MCAP format, if it is there: every file opens as
//! sound, and holds the messages that the suite says it does.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::path::{Path, PathBuf};
use std::process::Command;

use recording::Recording;
use serde_json::Value;

/// The suite is larger than this repository, and stands beside it.
const SUITE: &str = "../../../shared/data/mcap_conformance/data.tar.gz";
const FILES: usize = 416;

#[test]
fn every_file_of_the_suite_is_sound() {
    let suite = Path::new(env!("CARGO_MANIFEST_DIR")).join(SUITE);
    if !suite.exists() {
        eprintln!(
            "SKIPPED: the suite of MCAP files is not at {}",
            suite.display()
        );
        return;
    }
    let folder = tempfile::TempDir::new().unwrap();
    let unpacked = Command::new("tar")
        .arg("-xzf")
        .arg(&suite)
        .arg("-C")
        .arg(folder.path())
        .status()
        .expect("tar is there");
    assert!(unpacked.success());

    let files = recordings(folder.path());
    assert_eq!(files.len(), FILES);
    for file in files {
        let expected = std::fs::read(file.with_extension("json")).unwrap();
        let expected: Value = serde_json::from_slice(&expected).unwrap();
        let expected = messages(&expected);
        let recording = Recording::open(&file).unwrap();
        let name = file.display();
        assert_eq!(recording.damage(), None, "{name}");
        assert_eq!(recording.messages(), expected.len() as u64, "{name}");
        let times = expected.iter().min().zip(expected.iter().max());
        let times = times.map(|(first, last)| (*first, *last));
        assert_eq!(recording.time_range_ns(), times, "{name}");
        // They are of no type that is decoded.
        assert_eq!(recording.records().count(), 0, "{name}");
    }
}

fn recordings(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("it is a folder") {
        let path = entry.expect("it is readable").path();
        if path.is_dir() {
            found.extend(recordings(&path));
        } else if path.extension().is_some_and(|suffix| suffix == "mcap") {
            found.push(path);
        }
    }
    found
}

/// The log times of a file's messages, in its order.
fn messages(expected: &Value) -> Vec<i64> {
    let records = expected["records"].as_array().expect("a list of records");
    let is_message = |record: &&Value| record["type"] == "Message";
    records.iter().filter(is_message).map(log_time).collect()
}

/// Fields are pairs of a name and a number as text.
fn log_time(record: &Value) -> i64 {
    let fields = record["fields"].as_array().expect("a list of fields");
    let field = fields.iter().find(|field| field[0] == "log_time");
    let text = field.and_then(|field| field[1].as_str());
    text.and_then(|text| text.parse().ok()).expect("a number")
}
