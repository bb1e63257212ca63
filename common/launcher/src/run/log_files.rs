//! Writes the nodes' log to JSON lines, rotated when full. A write error only costs lines.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, create_dir_all, rename};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::console::{LAUNCHER, say};
use crate::control::LogLine;

const MAX_BYTES: u64 = 10_000_000;
const KEPT: usize = 4;

#[derive(Debug)]
pub(crate) struct LogFiles {
    folder: PathBuf,
    max_bytes: u64,
    open: BTreeMap<String, LogFile>,
    failed: bool,
}

#[derive(Debug)]
struct LogFile {
    file: File,
    bytes: u64,
}

impl LogFiles {
    pub(crate) fn create(folder: &Path) -> anyhow::Result<Self> {
        create_dir_all(folder)
            .with_context(|| format!("cannot create the folder {}", folder.display()))?;
        Ok(LogFiles {
            folder: folder.to_owned(),
            max_bytes: MAX_BYTES,
            open: BTreeMap::new(),
            failed: false,
        })
    }

    pub(crate) fn write(&mut self, line: &LogLine) {
        let failed = self.try_write(line).err();
        if let (Some(error), false) = (&failed, self.failed) {
            let folder = self.folder.display();
            say(LAUNCHER, &format!("cannot write logs in {folder}: {error}"));
        }
        self.failed = failed.is_some();
    }

    fn try_write(&mut self, line: &LogLine) -> io::Result<()> {
        let text = line.json();
        let node = file_name(&line.node);
        let is_full = |open: &LogFile| open.bytes + text.len() as u64 > self.max_bytes;
        if self.open.get(&node).is_some_and(is_full) {
            self.open.remove(&node);
            self.rotate(&node)?;
        }
        if !self.open.contains_key(&node) {
            let mut options = OpenOptions::new();
            let file = options.append(true).create(true);
            let file = file.open(self.path(&node, 0))?;
            let bytes = file.metadata()?.len();
            self.open.insert(node.clone(), LogFile { file, bytes });
        }
        if let Some(open) = self.open.get_mut(&node) {
            open.file.write_all(text.as_bytes())?;
            open.bytes += text.len() as u64;
        }
        Ok(())
    }

    fn rotate(&self, node: &str) -> io::Result<()> {
        for number in (0..KEPT).rev() {
            match rename(self.path(node, number), self.path(node, number + 1)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }

    fn path(&self, node: &str, number: usize) -> PathBuf {
        self.folder.join(match number {
            0 => format!("{node}.jsonl"),
            _ => format!("{node}.{number}.jsonl"),
        })
    }
}

/// Makes a node's name safe as a file name: any member of the graph may log.
fn file_name(node: &str) -> String {
    node.replace(|c: char| !c.is_ascii_alphanumeric() && c != '-', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(node: &str, text: &str) -> LogLine {
        LogLine {
            wall_ns: 5,
            node: node.to_owned(),
            pid: 7,
            level: "INFO",
            text: text.to_owned(),
        }
    }

    #[test]
    fn full_files_are_followed_by_others_and_the_oldest_ones_go() {
        let folder = tempfile::tempdir().unwrap();
        let mut files = LogFiles::create(&folder.path().join("logs")).unwrap();
        // One line fills a file.
        files.max_bytes = 100;
        for number in 0..8 {
            files.write(&line("tracker", &format!("line {number}")));
        }
        files.write(&line("../map", "elsewhere"));
        let read = |name: &str| {
            let text = std::fs::read_to_string(folder.path().join("logs").join(name)).unwrap();
            let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
            let texts = lines.map(|line: serde_json::Value| line["text"].clone());
            texts.collect::<Vec<_>>()
        };
        for (name, text) in [
            ("tracker.jsonl", "line 7"),
            ("tracker.1.jsonl", "line 6"),
            ("tracker.4.jsonl", "line 3"),
            ("___map.jsonl", "elsewhere"),
        ] {
            assert_eq!(read(name), [text], "{name}");
        }
        let files = std::fs::read_dir(folder.path().join("logs")).unwrap();
        assert_eq!(files.count(), 1 + KEPT + 1);
    }

    #[test]
    fn a_later_launcher_appends() {
        let folder = tempfile::tempdir().unwrap();
        for _ in 0..2 {
            let mut files = LogFiles::create(folder.path()).unwrap();
            files.write(&line("tracker", "hello"));
        }
        let text = std::fs::read_to_string(folder.path().join("tracker.jsonl")).unwrap();
        assert_eq!(text.lines().count(), 2);
    }
}
