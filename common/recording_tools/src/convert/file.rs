//! Detects the format of a file, and reads the lines of a log.
//!
//! The content decides if the extension does not; compression with gzip is detected from the
//! content alone.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::carmen;

const GZIP: &[u8] = b"\x1f\x8b";

/// Magic of recordings and bags; whether they can be read is checked elsewhere.
const RECORDINGS: [&[u8]; 4] = [
    b"\x89MCAP0\r\n",
    b"SQLite format 3\0",
    b"#ROSBAG V",
    b"\x28\xb5\x2f\xfd",
];

const HEAD_BYTES: u64 = 64 << 10;

/// Longest line: 36000 ranges and as many remissions of twelve digits need less.
const MAX_LINE_BYTES: u64 = 1 << 20;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Log,
    /// A recording or bag, or a folder of such.
    Recording,
    Unknown,
}

pub(super) fn kind(path: &Path) -> io::Result<Kind> {
    if path.is_dir() {
        return Ok(Kind::Recording);
    }
    let mut head = Vec::new();
    // A file that is cut within its head is still detected by the rest.
    let read = open(path)?.take(HEAD_BYTES).read_to_end(&mut head);
    if head.is_empty() {
        read?;
    }
    if RECORDINGS.iter().any(|start| head.starts_with(start)) {
        return Ok(Kind::Recording);
    }
    Ok(match ending(path).as_str() {
        "mcap" | "db3" | "bag" => Kind::Recording,
        "log" | "clf" | "txt" => Kind::Log,
        _ if is_log(&head) => Kind::Log,
        _ => Kind::Unknown,
    })
}

/// Extension of a file in lower case, without that of gzip.
pub(super) fn ending(path: &Path) -> String {
    let lower = |path: &Path| {
        let ending = path.extension().unwrap_or_default();
        ending.to_string_lossy().to_ascii_lowercase()
    };
    match lower(path).as_str() {
        "gz" => lower(Path::new(path.file_stem().unwrap_or_default())),
        other => other.to_owned(),
    }
}

pub(super) fn open(path: &Path) -> io::Result<Box<dyn BufRead>> {
    let mut file = BufReader::new(File::open(path)?);
    if file.fill_buf()?.starts_with(GZIP) {
        Ok(Box::new(BufReader::new(MultiGzDecoder::new(file))))
    } else {
        Ok(Box::new(file))
    }
}

/// Passes each line to `on_line` with its number, from 1; a line that is too long is cut. The inner
/// result is the error if the log cannot be read to its end.
pub(super) fn for_each_line<E>(
    mut log: impl BufRead,
    mut on_line: impl FnMut(u64, &str) -> Result<(), E>,
) -> Result<io::Result<()>, E> {
    let mut line = Vec::new();
    for number in 1.. {
        match read_line(&mut log, &mut line) {
            Ok(0) => break,
            Ok(_) => {}
            Err(error) => return Ok(Err(error)),
        }
        // Logs are ASCII, except for comments and host names.
        let text = String::from_utf8_lossy(&line);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        on_line(number, text)?;
    }
    Ok(Ok(()))
}

fn read_line(log: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<usize> {
    line.clear();
    let read = log.take(MAX_LINE_BYTES).read_until(b'\n', line)?;
    if read as u64 == MAX_LINE_BYTES && !line.ends_with(b"\n") {
        log.skip_until(b'\n')?;
    }
    Ok(read)
}

fn is_log(head: &[u8]) -> bool {
    head.split(|byte| *byte == b'\n').any(|line| {
        let text = String::from_utf8_lossy(line);
        text.split_ascii_whitespace()
            .next()
            .is_some_and(carmen::is_known)
    })
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::write::GzEncoder;

    use super::*;

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn endings_and_contents_show_the_kind() {
        let folder = tempfile::tempdir().unwrap();
        let kind_of = |name: &str, content: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            kind(&path).unwrap()
        };
        let log = b"# a log\nODOM 1 2 3\n";
        for name in "a.log a.CLF a.Txt a.log.gz a.TXT.GZ a.gz a a.log.old".split(' ') {
            assert_eq!(kind_of(name, log), Kind::Log, "{name}");
            assert_eq!(kind_of(name, &packed(log)), Kind::Log, "{name}");
            assert_eq!(kind_of(name, b"\x89MCAP0\r\n.."), Kind::Recording, "{name}");
        }
        assert_eq!(kind_of("a.log", b""), Kind::Log);
        assert_eq!(kind_of("a.txt", b"hello"), Kind::Log);
        for name in ["a.mcap", "a.MCAP", "a.db3", "a.mcap.gz"] {
            assert_eq!(kind_of(name, b"hello"), Kind::Recording, "{name}");
        }
        assert_eq!(kind_of("a.csv", b"hello\nODOMETRY"), Kind::Unknown);
        assert_eq!(kind(folder.path()).unwrap(), Kind::Recording);
        assert!(kind(&folder.path().join("none.log")).is_err());
    }

    #[test]
    fn lines_of_any_length_are_handed_over() {
        let long = "x".repeat(2 * MAX_LINE_BYTES as usize);
        let text = format!("\u{feff}one\r\n{long}\n\nfour");
        let mut lines = Vec::new();
        let outcome = for_each_line(text.as_bytes(), |number, line| {
            lines.push((number, line.trim_end().to_owned()));
            Ok::<_, ()>(())
        });
        outcome.unwrap().unwrap();
        let cut = "x".repeat(MAX_LINE_BYTES as usize);
        let expected = [(1, "one"), (2, &*cut), (3, ""), (4, "four")];
        assert_eq!(
            lines,
            expected.map(|(number, line)| (number, line.to_owned()))
        );
    }

    #[test]
    fn a_packed_log_is_unpacked_and_one_that_is_cut_ends_in_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.log.gz");
        // Concatenated gzip files count as one.
        let whole = [packed(b"one\n"), packed(b"two\n")].concat();
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            let mut lines = Vec::new();
            let outcome = for_each_line(open(&path).unwrap(), |_, line| {
                lines.push(line.to_owned());
                Ok::<_, ()>(())
            });
            (lines, outcome.unwrap().is_ok())
        };
        let (lines, is_whole) = read(&whole);
        assert!(is_whole && lines == ["one\n", "two\n"], "{lines:?}");
        let (lines, is_whole) = read(&whole[..whole.len() - 9]);
        assert!(!is_whole && lines[0] == "one\n", "{lines:?}");
    }
}
