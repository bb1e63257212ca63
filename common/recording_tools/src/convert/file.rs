//! Detects logs, and reads their lines.
//!
//! The content decides if the extension does not; compression with gzip is detected from the
//! content alone.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::carmen;

const GZIP: &[u8] = b"\x1f\x8b";

/// Extensions of recordings and bags; whether they can be read is checked elsewhere.
pub(super) const RECORDINGS: [&str; 3] = ["mcap", "db3", "bag"];

const HEAD_BYTES: u64 = 64 << 10;

/// Longest line: 36000 ranges and as many remissions of twelve digits need less.
const MAX_LINE_BYTES: u64 = 1 << 20;

/// True if the file is a log, by its name or, if that does not decide, by its content.
pub(super) fn is_log(path: &Path) -> io::Result<bool> {
    if path.is_dir() {
        return Ok(false);
    }
    let mut head = Vec::new();
    // A file that is cut within its head is still detected by the rest.
    let read = open(path)?.take(HEAD_BYTES).read_to_end(&mut head);
    if head.is_empty() {
        read?;
    }
    let is_line = |line: &[u8]| {
        let text = String::from_utf8_lossy(line);
        let name = text.split_ascii_whitespace().next();
        name.is_some_and(carmen::is_known)
    };
    Ok(match ending(path).as_str() {
        _ if recording::is_recording(path) => false,
        "log" | "clf" | "txt" => true,
        other if RECORDINGS.contains(&other) => false,
        _ => head.split(|byte| *byte == b'\n').any(is_line),
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

/// Passes each line to `on_line` with its number, from 1; a line that is too long is cut.
/// Fails if the log cannot be read to its end.
pub(super) fn for_each_line(
    mut log: impl BufRead,
    mut on_line: impl FnMut(u64, &str),
) -> io::Result<()> {
    let mut line = Vec::new();
    for number in 1.. {
        if read_line(&mut log, &mut line)? == 0 {
            break;
        }
        // Logs are ASCII, except for comments and host names.
        let text = String::from_utf8_lossy(&line);
        on_line(number, text.strip_prefix('\u{feff}').unwrap_or(&text));
    }
    Ok(())
}

fn read_line(log: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<usize> {
    line.clear();
    let read = log.take(MAX_LINE_BYTES).read_until(b'\n', line)?;
    if read as u64 == MAX_LINE_BYTES && !line.ends_with(b"\n") {
        log.skip_until(b'\n')?;
    }
    Ok(read)
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
    fn endings_and_contents_show_a_log() {
        let folder = tempfile::tempdir().unwrap();
        let is_log_named = |name: &str, content: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            is_log(&path).unwrap()
        };
        let log = b"# a log\nODOM 1 2 3\n";
        for name in "a.log a.CLF a.Txt a.log.gz a.TXT.GZ a.gz a a.log.old".split(' ') {
            assert!(is_log_named(name, log), "{name}");
            assert!(is_log_named(name, &packed(log)), "{name}");
            assert!(!is_log_named(name, b"\x89MCAP0\r\n.."), "{name}");
        }
        assert!(is_log_named("a.log", b"") && is_log_named("a.txt", b"hello"));
        for name in ["a.mcap", "a.MCAP", "a.db3", "a.mcap.gz"] {
            assert!(!is_log_named(name, log), "{name}");
        }
        assert!(!is_log_named("a.csv", b"hello\nODOMETRY"));
        assert!(!is_log(folder.path()).unwrap());
        assert!(is_log(&folder.path().join("none.log")).is_err());
    }

    #[test]
    fn lines_of_any_length_are_handed_over() {
        let long = "x".repeat(2 * MAX_LINE_BYTES as usize);
        let text = format!("\u{feff}one\r\n{long}\n\nfour");
        let mut lines = Vec::new();
        let outcome = for_each_line(text.as_bytes(), |number, line| {
            lines.push((number, line.trim_end().to_owned()));
        });
        outcome.unwrap();
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
            });
            (lines, outcome.is_ok())
        };
        let (lines, is_whole) = read(&whole);
        assert!(is_whole && lines == ["one\n", "two\n"], "{lines:?}");
        let (lines, is_whole) = read(&whole[..whole.len() - 9]);
        assert!(!is_whole && lines[0] == "one\n", "{lines:?}");
    }
}
