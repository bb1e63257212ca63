//! Runs the published conformance suite of MCAP: every file opens as sound and holds exactly the
//! messages, attachments and metadata that the suite lists.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::Command;

use recording::Recording;
use serde_json::{Map, Value};

/// From <https://github.com/foxglove/mcap>, `tests/conformance/data`, MIT licence.
const SUITE: &str = "tests/conformance/data.tar.gz";
const FILES: usize = 416;

#[test]
fn every_file_of_the_suite_is_read_as_the_suite_says() {
    let suite = Path::new(env!("CARGO_MANIFEST_DIR")).join(SUITE);
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
    let mut compared = [0; 3];
    for file in files {
        let expected = std::fs::read(file.with_extension("json")).unwrap();
        let expected: Value = serde_json::from_slice(&expected).unwrap();
        compare(&file, &expected, &mut compared);
    }
    assert_eq!(compared, ALL);
}

/// Numbers of messages, attachments and metadata in all files.
const ALL: [usize; 3] = [1768, 14, 14];

fn compare(file: &Path, expected: &Value, compared: &mut [usize; 3]) {
    let name = file.display();
    let recording = Recording::open(file).unwrap();
    assert_eq!(recording.damage(), None, "{name}");

    // The suite lists messages in time order; equal times in the order of the file.
    let mut messages = of_type(expected, "Message");
    messages.sort_by_key(|message| number(&message["log_time"]));
    assert_eq!(recording.messages(), messages.len() as u64, "{name}");
    let found: Vec<_> = recording.raw_records().map(Result::unwrap).collect();
    assert_eq!(found.len(), messages.len(), "{name}");
    let channels = of_type(expected, "Channel");
    for (found, message) in found.iter().zip(&messages) {
        let is_own = |channel: &&Map<String, Value>| channel["id"] == message["channel_id"];
        let channel = channels.iter().find(is_own).expect("the suite names it");
        let times = [found.log_time_ns, found.publish_time_ns as i64];
        let expected = ["log_time", "publish_time"].map(|key| number(&message[key]));
        assert_eq!(times, expected, "{name}");
        assert_eq!(found.body, bytes(&message["data"]), "{name}");
        let (topic, encoding) = (&found.channel.topic, &found.channel.encoding);
        assert_eq!(**topic, channel["topic"], "{name}");
        assert_eq!(*encoding, channel["message_encoding"], "{name}");
    }

    let attachments = of_type(expected, "Attachment");
    assert_eq!(recording.attachments().len(), attachments.len(), "{name}");
    for (found, attachment) in recording.attachments().iter().zip(&attachments) {
        assert_eq!(found.name, attachment["name"], "{name}");
        assert_eq!(found.media_type, attachment["media_type"], "{name}");
        let log_time = number(&attachment["log_time"]);
        assert_eq!(found.log_time_ns as i64, log_time, "{name}");
        let content = recording.content_of(found);
        assert_eq!(content, bytes(&attachment["data"]), "{name}");
    }

    let metadata = of_type(expected, "Metadata");
    assert_eq!(recording.metadata().len(), metadata.len(), "{name}");
    for (found, metadata) in recording.metadata().iter().zip(&metadata) {
        assert_eq!(found.name, metadata["name"], "{name}");
        let entries = serde_json::to_value(&found.entries).unwrap();
        assert_eq!(entries, metadata["metadata"], "{name}");
    }
    for (count, more) in compared.iter_mut().zip([messages, attachments, metadata]) {
        *count += more.len();
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

fn of_type(expected: &Value, kind: &str) -> Vec<Map<String, Value>> {
    let records = expected["records"].as_array().expect("a list of records");
    let of_kind = records.iter().filter(|record| record["type"] == kind);
    of_kind.map(fields).collect()
}

fn fields(record: &Value) -> Map<String, Value> {
    let fields = record["fields"].as_array().expect("a list of fields");
    let pair = |field: &Value| {
        let name = field[0].as_str().expect("a name");
        (name.to_owned(), field[1].clone())
    };
    fields.iter().map(pair).collect()
}

fn number(value: &Value) -> i64 {
    let text = value.as_str().expect("a number as text");
    text.parse().expect("a number")
}

fn bytes(value: &Value) -> Vec<u8> {
    let bytes = value.as_array().expect("a list of bytes");
    bytes.iter().map(|byte| number(byte) as u8).collect()
}
