//! Tests of rosbag2 bags: folders with several parts, compressed or not, made from the recording of
//! the corridor.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::Cursor;
use std::path::{Path, PathBuf};

use recording::write::{Packing, RecordingWriter};
use recording::{Kind, Record, Recording, RecordingError};
use tempfile::TempDir;

const CORRIDOR: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../recordings/malaga_corridor/recording.mcap"
);

fn records(recording: &Recording) -> Vec<Record> {
    recording.records().map(Result::unwrap).collect()
}

/// Splits the corridor into parts that overlap in time: message i goes to part i modulo `parts`;
/// the map and the mount, which come first, only go to the first part.
fn split(folder: &Path, parts: usize, pack: fn(&[u8]) -> Vec<u8>) -> Vec<PathBuf> {
    let corridor = Recording::open(CORRIDOR).unwrap();
    let mut writers: Vec<_> = (0..parts)
        .map(|_| RecordingWriter::in_memory(Packing::Zstd).unwrap())
        .collect();
    for (index, record) in corridor.raw_records().enumerate() {
        let record = record.unwrap();
        let is_of_first = matches!(
            record.channel.kind,
            Some(Kind::Map | Kind::StaticTransforms)
        );
        let writer = &mut writers[if is_of_first { 0 } else { index % parts }];
        let (topic, schema) = (&record.channel.topic, &record.channel.schema);
        let body = pack(&record.body);
        writer
            .write_bytes(topic, schema, "", "cdr", record.log_time_ns, &body)
            .unwrap();
    }
    let path = |(index, writer): (usize, RecordingWriter<Cursor<Vec<u8>>>)| {
        let path = folder.join(format!("drive_{index}.mcap"));
        std::fs::write(&path, writer.finish().unwrap().into_inner()).unwrap();
        path
    };
    writers.into_iter().enumerate().map(path).collect()
}

fn as_it_is(body: &[u8]) -> Vec<u8> {
    body.to_vec()
}

fn packed(body: &[u8]) -> Vec<u8> {
    zstd::encode_all(body, 3).unwrap()
}

/// Asserts that all messages are there in time order, and the map and the mount.
fn assert_is_corridor(found: &Recording) {
    let corridor = Recording::open(CORRIDOR).unwrap();
    let (all, expected) = (records(found), records(&corridor));
    assert_eq!(all.len(), expected.len());
    assert!(all.is_sorted_by_key(|record| record.log_time_ns));
    assert!(expected.iter().all(|record| all.contains(record)));
    assert_eq!(found.messages(), corridor.messages());
    assert_eq!(found.time_range_ns(), corridor.time_range_ns());
    assert_eq!(found.map().unwrap(), corridor.map().unwrap());
    assert_eq!(found.ground_truths().unwrap().len(), 37);
    let mount = found.base_from_laser("laser").unwrap();
    assert_eq!(mount, corridor.base_from_laser("laser").unwrap());
    let topics = found.channels().filter(|c| c.kind == Some(Kind::Scan));
    let counts: Vec<u64> = topics.map(|channel| channel.messages).collect();
    assert_eq!(counts, [37], "a topic of several files is one");
}

fn describe(folder: &Path, names: &[&str]) {
    let names: String = names.iter().map(|name| format!("  - {name}\n")).collect();
    let text = format!("rosbag2_bagfile_information:\n  relative_file_paths:\n{names}");
    std::fs::write(folder.join("metadata.yaml"), text).unwrap();
}

#[test]
fn the_parts_of_a_folder_are_one_recording() {
    let folder = TempDir::new().unwrap();
    let paths = split(folder.path(), 3, as_it_is);
    assert_is_corridor(&Recording::open(folder.path()).unwrap());
    assert_is_corridor(&Recording::open_all(&paths).unwrap());
    describe(
        folder.path(),
        &["drive_2.mcap", "drive_0.mcap", "drive_1.mcap"],
    );
    assert_is_corridor(&Recording::open(folder.path()).unwrap());
    assert_is_corridor(&Recording::open(folder.path().join("metadata.yaml")).unwrap());
    // Like the expansion of `drive/*` by a shell.
    let all: Vec<PathBuf> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert_eq!(all.len(), 4);
    assert_is_corridor(&Recording::open_all(&all).unwrap());
}

#[test]
fn packed_messages_and_packed_files_are_unpacked() {
    let folder = TempDir::new().unwrap();
    for path in split(folder.path(), 2, packed) {
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(path.with_extension("mcap.zstd"), packed(&bytes)).unwrap();
        std::fs::remove_file(path).unwrap();
    }
    assert_is_corridor(&Recording::open(folder.path()).unwrap());
    // The names in the description may have the extension of compression or not.
    describe(folder.path(), &["drive_0.mcap", "drive_1.mcap.zstd"]);
    assert_is_corridor(&Recording::open(folder.path()).unwrap());
    let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
    let messages = recording::write_bag(folder.path(), &mut writer).unwrap();
    let copy = writer.finish().unwrap().into_inner();
    let copy = Recording::from_bytes("copy.mcap", copy).unwrap();
    assert_eq!(copy.messages(), messages);
    assert_is_corridor(&copy);
    let is_packed = |body: &[u8]| body.starts_with(&[0x28, 0xb5, 0x2f, 0xfd]);
    let mut raw = copy.raw_records();
    assert!(raw.all(|record| !is_packed(&record.unwrap().body)));
}

#[test]
fn a_part_that_is_cut_short_is_named_behind_all_that_is_readable() {
    let folder = TempDir::new().unwrap();
    let paths = split(folder.path(), 2, as_it_is);
    let bytes = std::fs::read(&paths[1]).unwrap();
    for length in [bytes.len() - 40, 0] {
        std::fs::write(&paths[1], &bytes[..length]).unwrap();
        let recording = Recording::open(folder.path()).unwrap();
        let mut items: Vec<_> = recording.records().collect();
        let last = items.pop().unwrap().unwrap_err();
        assert!(
            matches!(&last, RecordingError::Damaged { path, .. } if *path == paths[1]),
            "{last}"
        );
        assert!(!items.is_empty() && items.into_iter().all(|item| item.is_ok()));
        assert!(recording.map().unwrap().is_some());
    }
    std::fs::write(&paths[0], b"").unwrap();
    let nothing = Recording::open(folder.path()).unwrap_err().to_string();
    assert!(
        nothing.contains("drive_0.mcap: the file starts with nothing"),
        "{nothing}"
    );
}

#[test]
fn what_cannot_be_read_is_named() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("drive_0.mcap.gz");
    std::fs::write(&file, b"\x1f\x8b\x08...").unwrap();
    let refusal = |path: &Path| Recording::open(path).unwrap_err().to_string();
    let expected = format!(
        "{file} is packed with gzip: unpack it with `gunzip --keep {file}`",
        file = file.display()
    );
    assert_eq!(refusal(&file), expected);
    assert_eq!(refusal(folder.path()), expected, "nothing else is there");
    describe(folder.path(), &["drive_0.mcap"]);
    assert_eq!(refusal(folder.path()), expected);
    let broken = folder.path().join("drive.mcap.zstd");
    let bytes = std::fs::read(CORRIDOR).unwrap();
    std::fs::write(&broken, &packed(&bytes)[..1000]).unwrap();
    let found = refusal(&broken);
    assert!(
        found.contains("drive.mcap.zstd cannot be unpacked: its zstd is broken"),
        "{found}"
    );
    std::fs::write(&broken, packed(b"anything else")).unwrap();
    let found = refusal(&broken);
    assert!(
        found.ends_with("is neither an MCAP file nor a bag in SQLite"),
        "{found}"
    );
}
