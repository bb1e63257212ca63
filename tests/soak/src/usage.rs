//! Memory and file descriptors of a graph's processes, as Linux reports in /proc.

use std::collections::BTreeMap;
use std::fs::{read_dir, read_to_string};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use serde::Serialize;

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Span {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) peak: f64,
}

impl Span {
    fn add(span: &mut Option<Span>, value: f64) {
        let span = span.get_or_insert(Span {
            start: value,
            end: value,
            peak: value,
        });
        span.end = value;
        span.peak = span.peak.max(value);
    }
}

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(super) struct Taken {
    /// Private memory, without shared memory, MB of 10⁶ bytes.
    pub(super) memory_mb: Option<Span>,
    /// Number of open files, sockets and other descriptors.
    pub(super) descriptors: Option<Span>,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(super) struct Usage {
    /// By node; the launcher counts as one.
    pub(super) nodes: BTreeMap<String, Taken>,
    /// Size of the graph's files in /dev/shm, MB of 10⁶ bytes.
    pub(super) shared_memory_mb: Option<Span>,
}

impl Usage {
    /// Samples a process of a node; one that has just ended is skipped.
    pub(super) fn look_at(&mut self, node: &str, pid: i32) {
        let process = PathBuf::from(format!("/proc/{pid}"));
        let status = read_to_string(process.join("status"));
        let Some(bytes) = status.ok().and_then(|status| own_bytes(&status)) else {
            return;
        };
        let taken = self.nodes.entry(node.to_owned()).or_default();
        Span::add(&mut taken.memory_mb, bytes / 1e6);
        if let Ok(open) = read_dir(process.join("fd")) {
            Span::add(&mut taken.descriptors, open.count() as f64);
        }
    }

    pub(super) fn look_at_files(&mut self, files: &[PathBuf]) {
        let shared = files.iter().filter(|file| file.starts_with("/dev/shm"));
        let bytes = shared.map(|file| room_of(file)).sum::<u64>();
        Span::add(&mut self.shared_memory_mb, bytes as f64 / 1e6);
    }
}

/// Allocated size of a file, which may be less than its length.
fn room_of(file: &Path) -> u64 {
    // The unit is fixed, see stat(2). A missing file has no size.
    file.symlink_metadata()
        .map_or(0, |found| found.blocks() * 512)
}

/// Parses the line `RssAnon:      1968 kB`; its unit is KiB.
fn own_bytes(status: &str) -> Option<f64> {
    let rest = status.lines().find_map(|l| l.strip_prefix("RssAnon:"))?;
    let kib: f64 = rest.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_keeps_first_last_and_highest() {
        let mut span = None;
        for value in [3.0, 9.0, 4.0] {
            Span::add(&mut span, value);
        }
        let expected = Span {
            start: 3.0,
            end: 4.0,
            peak: 9.0,
        };
        assert_eq!(span, Some(expected));
    }

    #[test]
    fn a_process_has_memory_and_open_files() {
        let mut usage = Usage::default();
        usage.look_at("self", std::process::id().cast_signed());
        usage.look_at("nobody", i32::MAX);
        assert_eq!(usage.nodes.keys().collect::<Vec<_>>(), ["self"]);
        let own = &usage.nodes["self"];
        assert!(own.memory_mb.unwrap().peak > 0.0);
        // The standard ones, and the folder that is being read.
        assert!(own.descriptors.unwrap().peak >= 4.0);
        assert_eq!(own_bytes("RssFile: 1 kB\nRssAnon:\t 2 kB\n"), Some(2048.0));
    }
}
