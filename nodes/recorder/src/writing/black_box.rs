//! Keeps the last minutes in memory and saves them on request.
//!
//! Nothing is written before. Messages older than configured or beyond the memory limit are
//! dropped; those that a reader needs (the map, the mounts) are kept for the head of the file.

use std::collections::VecDeque;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use command_line::output;
use recording::write::{Packing, RecordingWriter};
use ros_graph::export::Entry;

use super::{Preamble, Store, Tally, name};
use crate::RecorderError;

/// Memory of a message in addition to its bytes.
const OVERHEAD_BYTES: usize = 128;

/// Limits of the files of a black box on the disk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    pub(crate) files: u32,
    pub(crate) bytes: u64,
}

pub(crate) struct BlackBox {
    path: PathBuf,
    keep: Duration,
    capacity_bytes: usize,
    room: Room,
    saved_ns: Option<i64>,
    /// Events for the next file, with their counts.
    events: Vec<(String, u32)>,
    preamble: Preamble,
    kept: VecDeque<Entry>,
    bytes: usize,
    newest_ns: i64,
    tally: Tally,
}

impl BlackBox {
    /// Creates an empty black box; saved files are named after `path`.
    pub(crate) fn new(
        path: PathBuf,
        keep: Duration,
        capacity_bytes: usize,
        room: Room,
        preamble: Preamble,
    ) -> Self {
        BlackBox {
            path,
            keep,
            capacity_bytes,
            room,
            saved_ns: None,
            events: Vec::new(),
            preamble,
            kept: VecDeque::new(),
            bytes: 0,
            newest_ns: 0,
            tally: Tally::default(),
        }
    }

    /// Returns true if a file saved now would overlap the last one.
    fn is_in_last_file(&self) -> bool {
        self.saved_ns.is_some_and(|saved_ns| {
            let since_ns = i128::from(self.newest_ns) - i128::from(saved_ns);
            since_ns < self.keep.as_nanos() as i128
        })
    }

    fn save_due_events(&mut self) -> Result<(), RecorderError> {
        match self.is_in_last_file() {
            true => Ok(()),
            false => self.finish(),
        }
    }

    /// Removes the oldest files beyond the limits; the newest one always stays.
    fn remove_oldest(&self, newest: &Path) {
        let files = output::numbered(&self.path).into_iter();
        let files = files.filter(|path| path != newest).filter_map(|path| {
            let found = path.metadata().ok()?;
            Some((found.modified().ok()?, found.len(), path))
        });
        let mut files: Vec<_> = files.collect();
        // Sorted from newest to oldest.
        files.sort_unstable_by(|a, b| b.cmp(a));
        let newest_bytes = newest.metadata().map_or(0, |found| found.len());
        let (mut count, mut bytes) = (1, newest_bytes);
        for (_, size, path) in files {
            (count, bytes) = (count + 1, bytes + size);
            if count <= self.room.files && bytes <= self.room.bytes {
                continue;
            }
            match std::fs::remove_file(&path) {
                Ok(()) => tracing::info!("{} is removed: there are newer ones", path.display()),
                Err(error) => tracing::warn!("cannot remove {}: {error}", path.display()),
            }
        }
    }

    fn is_too_much(&self) -> bool {
        let is_old = self.first_ns().is_some_and(|first_ns| {
            let covered_ns = i128::from(self.newest_ns) - i128::from(first_ns);
            covered_ns > self.keep.as_nanos() as i128
        });
        is_old || self.bytes > self.capacity_bytes
    }

    fn first_ns(&self) -> Option<i64> {
        self.kept.iter().find_map(|entry| match entry {
            Entry::Message(message) => Some(message.log_time_ns),
            Entry::Metadata(..) => None,
        })
    }
}

impl Store for BlackBox {
    /// Adds an entry, drops entries beyond the limits, and saves a file if one is due.
    fn put(&mut self, entry: Entry) -> Result<(), RecorderError> {
        if let Entry::Message(message) = &entry {
            self.newest_ns = self.newest_ns.max(message.log_time_ns);
            self.tally.recorded += 1;
        }
        self.bytes += size(&entry);
        self.kept.push_back(entry);
        while self.is_too_much()
            && let Some(oldest) = self.kept.pop_front()
        {
            self.bytes -= size(&oldest);
            self.preamble.note(&oldest);
        }
        self.save_due_events()
    }

    /// Writes the entries to a file, and also keeps them.
    fn save(&mut self, why: &str) -> Result<(), RecorderError> {
        let (path, file) = name::create(&self.path, false)?;
        let mut writer = RecordingWriter::new(BufWriter::new(file), Packing::Zstd)?;
        let reason = [("reason".to_owned(), why.to_owned())].into();
        writer.write_metadata("backcast/saved", &reason)?;
        self.preamble.write(&mut writer, self.first_ns())?;
        for entry in &self.kept {
            match entry {
                Entry::Message(message) => writer.write_encoded(message)?,
                Entry::Metadata(name, entries) => writer.write_metadata(name, entries)?,
            }
        }
        let mut file = writer.finish()?;
        // Synced, so that the file survives a power failure.
        file.flush()
            .and_then(|()| file.get_ref().sync_data())
            .map_err(RecorderError::file(format!(
                "cannot write {}",
                path.display()
            )))?;
        self.tally.files += 1;
        self.saved_ns = Some(self.newest_ns);
        tracing::info!("{why}: saved to {}", path.display());
        self.remove_oldest(&path);
        Ok(())
    }

    fn happened(&mut self, event: &str) -> Result<(), RecorderError> {
        match self.events.iter_mut().find(|(other, _)| other == event) {
            Some((_, times)) => *times += 1,
            None => self.events.push((event.to_owned(), 1)),
        }
        self.save_due_events()
    }

    /// Saves if there are unsaved events.
    fn finish(&mut self) -> Result<(), RecorderError> {
        let events = std::mem::take(&mut self.events);
        let words = events.into_iter().map(|(event, times)| match times {
            1 => event,
            _ => format!("{event} ({times} times)"),
        });
        let words: Vec<String> = words.collect();
        match words.is_empty() {
            true => Ok(()),
            false => self.save(&words.join(", ")),
        }
    }

    fn tally(&self) -> Tally {
        self.tally
    }
}

fn size(entry: &Entry) -> usize {
    match entry {
        Entry::Message(message) => message.body.len() + OVERHEAD_BYTES,
        Entry::Metadata(..) => OVERHEAD_BYTES,
    }
}

#[cfg(test)]
mod tests {
    use recording::{MAP, Recording};
    use tempfile::TempDir;

    use super::super::testing::{SECOND, message, topics};
    use super::*;

    fn saved(folder: &TempDir, name: &str) -> Vec<(String, i64)> {
        let recording = Recording::open(folder.path().join(name)).unwrap();
        assert_eq!(recording.damage(), None);
        assert_eq!(recording.metadata()[0].entries["reason"], "asked");
        topics(&recording)
    }

    fn black_box(folder: &TempDir, keep_s: u64, capacity_bytes: usize) -> BlackBox {
        let path = folder.path().join("r.mcap");
        let keep = Duration::from_secs(keep_s);
        let room = Room {
            files: 3,
            bytes: 1 << 20,
        };
        BlackBox::new(path, keep, capacity_bytes, room, Preamble::default())
    }

    #[test]
    fn the_last_seconds_are_saved_with_the_map_from_before() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 3, 1 << 20);
        black_box.put(message(MAP, 0, true)).unwrap();
        for second in 0..10 {
            black_box.put(message("/n", second, false)).unwrap();
        }
        assert!(!folder.path().join("r.mcap").exists());
        black_box.save("asked").unwrap();
        let expected = |times: &[i64]| -> Vec<(String, i64)> {
            let map = (MAP.to_owned(), times[0]);
            let rest = times.iter().map(|time| ("/n".to_owned(), *time));
            [map].into_iter().chain(rest).collect()
        };
        assert_eq!(saved(&folder, "r.mcap"), expected(&[6, 7, 8, 9]));
        black_box.put(message("/n", 10, false)).unwrap();
        black_box.save("asked").unwrap();
        assert_eq!(saved(&folder, "r_1.mcap"), expected(&[7, 8, 9, 10]));
        assert_eq!(black_box.tally().files, 2);
    }

    #[test]
    fn events_that_would_overlap_the_last_file_share_the_next() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 4, 1 << 20);
        for second in 0..12 {
            black_box.put(message("/n", second, false)).unwrap();
            // An event each second from 3 to 6, and one at the end.
            if (3..7).contains(&second) || second == 11 {
                black_box.happened("asked").unwrap();
            }
        }
        let reason = |name: &str| {
            let recording = Recording::open(folder.path().join(name)).unwrap();
            let times = recording
                .raw_records()
                .map(|r| r.unwrap().log_time_ns / SECOND);
            let reason = recording.metadata()[0].entries["reason"].clone();
            (reason, times.collect::<Vec<_>>())
        };
        assert_eq!(reason("r.mcap"), ("asked".into(), vec![0, 1, 2, 3]));
        let all = ("asked (3 times)".into(), vec![3, 4, 5, 6, 7]);
        assert_eq!(reason("r_1.mcap"), all);
        assert_eq!(black_box.tally().files, 3);
        black_box.finish().unwrap();
        assert_eq!(black_box.tally().files, 3, "nothing waits");
    }

    #[test]
    fn the_oldest_files_give_way() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 1, 1 << 20);
        black_box.put(message("/n", 0, false)).unwrap();
        std::fs::write(folder.path().join("r_notes.mcap"), "").unwrap();
        for _ in 0..5 {
            black_box.save("asked").unwrap();
            // File times have the resolution of the system clock.
            std::thread::sleep(Duration::from_millis(20));
        }
        let mut names: Vec<_> = std::fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        // A name that has become free is used again.
        assert_eq!(names.len(), 4, "{names:?}");
        assert!(names.contains(&"r_notes.mcap".to_owned()), "{names:?}");
        black_box.room.bytes = 1;
        black_box.save("asked").unwrap();
        assert_eq!(output::numbered(&black_box.path).len(), 1);
    }

    #[test]
    fn memory_is_bounded() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 1000, 3 * 2128);
        for second in 0..10 {
            black_box.put(message("/n", second, false)).unwrap();
        }
        assert_eq!((black_box.kept.len(), black_box.bytes), (3, 3 * 2128));
    }
}
