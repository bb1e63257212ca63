//! Detects the format of a file from its first bytes; its name is ignored.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use mcap::MAGIC;

use crate::RecordingError;

const SQLITE: &[u8] = b"SQLite format 3\0";

const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

/// Magic of a skippable zstd frame, without the first byte, which is 0x50 to 0x5f.
const ZSTD_SKIPPED: &[u8] = &[0x2a, 0x4d, 0x18];

/// First line of a bag's `metadata.yaml`.
const METADATA: &[u8] = b"rosbag2_bagfile_information:";

const START: u64 = 64;

/// Known formats that are not supported: magic, name, and the command that unpacks the file, or
/// advice with a command in it.
const FOREIGN: [(&[u8], &str, &str); 7] = [
    (
        b"#ROSBAG V",
        "a bag of ROS 1",
        "convert it with `rosbags-convert --src FILE --dst BARE` (of `pip install rosbags`)",
    ),
    (b"\x1f\x8b", "packed with gzip", "gunzip --keep FILE"),
    (b"\xfd7zXZ\0", "packed with xz", "unxz --keep FILE"),
    (b"\x04\x22\x4d\x18", "packed with lz4", "lz4 -d FILE BARE"),
    (b"BZh", "packed with bzip2", "bunzip2 --keep FILE"),
    (b"PK\x03\x04", "a zip archive", "unzip FILE"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", "7z x FILE"),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    Mcap,
    Sqlite,
    Zstd,
    /// Description of a bag, next to its parts.
    Metadata,
    /// A known format that is not supported: its name and the advice.
    Foreign(&'static str, &'static str),
    Unknown,
}

impl Content {
    /// Detects the format of the file; a pipe is not read and unknown.
    pub(crate) fn of(path: &Path) -> Result<Self, RecordingError> {
        let unreadable = RecordingError::open(path);
        let mut start = Vec::new();
        if is_stream(path) {
            return Ok(Content::Unknown);
        }
        let file = File::open(path).map_err(unreadable)?;
        file.take(START)
            .read_to_end(&mut start)
            .map_err(unreadable)?;
        Ok(Content::of_bytes(&start))
    }

    pub(crate) fn of_bytes(start: &[u8]) -> Self {
        let foreign = FOREIGN.iter().find(|(magic, ..)| start.starts_with(magic));
        match foreign {
            _ if start.starts_with(MAGIC) => Content::Mcap,
            _ if start.starts_with(SQLITE) => Content::Sqlite,
            _ if is_packed(start) => Content::Zstd,
            _ if start.starts_with(METADATA) => Content::Metadata,
            Some(&(_, what, advice)) => Content::Foreign(what, advice),
            None => Content::Unknown,
        }
    }
}

/// True for a pipe or a device, which can be read only once; `-` is standard input.
pub fn is_stream(path: &Path) -> bool {
    match path.metadata() {
        Ok(found) => !found.is_file() && !found.is_dir(),
        Err(_) => path == Path::new("-"),
    }
}

pub(crate) fn is_packed(bytes: &[u8]) -> bool {
    let is_skipped = |bytes: &[u8]| match bytes.split_first() {
        Some((first, rest)) => first & 0xf0 == 0x50 && rest.starts_with(ZSTD_SKIPPED),
        None => false,
    };
    bytes.starts_with(ZSTD) || is_skipped(bytes)
}

pub(crate) fn foreign(path: &Path, what: &str, advice: &str) -> RecordingError {
    let file = path.display().to_string();
    let bare = path.with_extension("").display().to_string();
    let advice = match advice.contains('`') {
        true => advice.to_owned(),
        false => format!("unpack it with `{advice}`"),
    };
    let advice = advice.replace("FILE", &file).replace("BARE", &bare);
    RecordingError::Unfit(format!("{file} is {what}: {advice}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_is_detected_by_its_start() {
        for (start, expected) in [
            (&b"\x89MCAP0\r\n..."[..], Content::Mcap),
            (b"SQLite format 3\0...", Content::Sqlite),
            (b"\x28\xb5\x2f\xfd...", Content::Zstd),
            (b"\x5e\x2a\x4d\x18...", Content::Zstd),
            (
                b"rosbag2_bagfile_information:\n  version",
                Content::Metadata,
            ),
            (b"# CARMEN", Content::Unknown),
            (b"", Content::Unknown),
        ] {
            assert_eq!(Content::of_bytes(start), expected);
        }
    }

    #[test]
    fn what_is_foreign_is_named_with_the_command() {
        let said = |start: &[u8], path: &str| match Content::of_bytes(start) {
            Content::Foreign(what, advice) => foreign(Path::new(path), what, advice).to_string(),
            other => panic!("{other:?}"),
        };
        assert_eq!(
            said(b"#ROSBAG V2.0\n", "a/drive.bag"),
            "a/drive.bag is a bag of ROS 1: convert it with `rosbags-convert --src a/drive.bag \
             --dst a/drive` (of `pip install rosbags`)"
        );
        assert_eq!(
            said(b"\x1f\x8b\x08", "drive.mcap.gz"),
            "drive.mcap.gz is packed with gzip: unpack it with `gunzip --keep drive.mcap.gz`"
        );
        for (magic, what, _) in FOREIGN {
            assert!(said(magic, "r").starts_with(&format!("r is {what}: ")));
        }
    }
}
