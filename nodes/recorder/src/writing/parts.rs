//! Recording in one file, or in parts by size and time.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use recording::write::{Encoded, Packing, RecordingWriter};
use ros_graph::export::Entry;

use super::staged::{Progress, Staged};
use super::{Preamble, Store, Tally, name};
use crate::RecorderError;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Limits {
    pub(crate) split_bytes: Option<u64>,
    /// Duration of a part, by the times of its messages.
    pub(crate) split_time: Option<Duration>,
    /// Number of bytes in memory beyond which messages are dropped.
    pub(crate) waiting_bytes: usize,
}

pub(crate) struct Parts {
    path: PathBuf,
    limits: Limits,
    preamble: Preamble,
    part: Option<Part>,
    /// Newest file, and files finished since the last sync.
    unsynced: Vec<(PathBuf, File)>,
    tally: Tally,
}

struct Part {
    path: PathBuf,
    writer: RecordingWriter<Staged>,
    progress: Arc<Progress>,
    first_ns: Option<i64>,
    flushed: bool,
}

impl Parts {
    pub(crate) fn new(
        path: PathBuf,
        limits: Limits,
        preamble: Preamble,
    ) -> Result<Self, RecorderError> {
        let mut parts = Parts {
            path,
            limits,
            preamble,
            part: None,
            unsynced: Vec::new(),
            tally: Tally::default(),
        };
        parts.begin(None)?;
        parts.flush()?;
        Ok(parts)
    }

    fn try_put(&mut self, entry: &Entry) -> Result<(), RecorderError> {
        if let Entry::Message(message) = entry {
            self.split_before(message)?;
        }
        self.preamble.note(entry);
        let Some(part) = &mut self.part else {
            return Err(RecorderError::ThreadEnded);
        };
        match entry {
            Entry::Metadata(name, entries) => part.writer.write_metadata(name, entries)?,
            Entry::Message(_) if part.progress.waiting() > self.limits.waiting_bytes => {
                self.tally.dropped += 1;
            }
            Entry::Message(message) => {
                part.writer.write_encoded(message)?;
                part.first_ns.get_or_insert(message.log_time_ns);
                self.tally.recorded += 1;
            }
        }
        Ok(())
    }

    /// Finishes the part if it is full. While the disk is full, the part stays open, since
    /// finishing a part cannot be retried.
    fn split_before(&mut self, message: &Encoded) -> Result<(), RecorderError> {
        if self.part.is_none() {
            // The previous part could not be finished.
            return self.begin(Some(message.log_time_ns));
        }
        let is_full = self
            .part
            .as_ref()
            .is_some_and(|part| self.limits.reached(part, message));
        if !is_full {
            return Ok(());
        }
        if self.flush().is_err() {
            return Ok(());
        }
        self.finish()?;
        self.begin(Some(message.log_time_ns))
    }

    fn begin(&mut self, from_ns: Option<i64>) -> Result<(), RecorderError> {
        let numbered = self.limits.split_bytes.is_some() || self.limits.split_time.is_some();
        let (path, file) = name::create(&self.path, numbered)?;
        tracing::info!("recording to {}", path.display());
        let again = file.try_clone().map_err(unsynced(&path))?;
        self.unsynced.push((path.clone(), again));
        let progress = Arc::new(Progress::default());
        let sink = Staged::new(file, Arc::clone(&progress));
        let mut writer = RecordingWriter::new(sink, Packing::Zstd)?;
        self.preamble.write(&mut writer, from_ns)?;
        self.part = Some(Part {
            path,
            writer,
            progress,
            first_ns: from_ns,
            flushed: true,
        });
        self.tally.files += 1;
        Ok(())
    }
}

impl Store for Parts {
    /// Writes an entry; a message that cannot be written is counted as dropped.
    fn put(&mut self, entry: Entry) -> Result<(), RecorderError> {
        let outcome = self.try_put(&entry);
        if outcome.is_err() && matches!(entry, Entry::Message(_)) {
            self.tally.dropped += 1;
        }
        outcome
    }

    fn flush(&mut self) -> Result<(), RecorderError> {
        let Some(part) = &mut self.part else {
            return Ok(());
        };
        part.flushed = false;
        part.writer.flush()?;
        part.flushed = true;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), RecorderError> {
        let Some(part) = self.part.take() else {
            return Ok(());
        };
        let mut file = part.writer.finish()?;
        file.flush().map_err(RecorderError::file(format!(
            "cannot end the recording {}: what was flushed before that is readable",
            part.path.display()
        )))
    }

    fn sync(&mut self) -> Result<(), RecorderError> {
        for (path, file) in &self.unsynced {
            file.sync_data().map_err(unsynced(path))?;
        }
        // Finished files do not change any more.
        let ended = match self.part {
            Some(_) => self.unsynced.len().saturating_sub(1),
            None => self.unsynced.len(),
        };
        self.unsynced.drain(..ended);
        Ok(())
    }

    fn tally(&self) -> Tally {
        self.tally
    }
}

fn unsynced(path: &Path) -> impl FnOnce(std::io::Error) -> RecorderError {
    RecorderError::file(format!(
        "cannot sync the recording {} to the disk",
        path.display()
    ))
}

impl Limits {
    fn reached(&self, part: &Part, next: &Encoded) -> bool {
        // The chunk being compressed comes on top: about one second of messages.
        let by_size = self
            .split_bytes
            .is_some_and(|limit| part.progress.all() >= limit);
        let by_time = part
            .first_ns
            .zip(self.split_time)
            .is_some_and(|(first_ns, limit)| {
                i128::from(next.log_time_ns) - i128::from(first_ns) >= limit.as_nanos() as i128
            });
        part.flushed && part.first_ns.is_some() && (by_size || by_time)
    }
}

#[cfg(test)]
mod tests {
    use recording::{MAP, Recording};
    use tempfile::TempDir;

    use super::super::testing::{message, topics};
    use super::*;

    fn parts(folder: &TempDir, split_bytes: Option<u64>, split_time: Option<u64>) -> Parts {
        let limits = Limits {
            split_bytes,
            split_time: split_time.map(Duration::from_secs),
            waiting_bytes: 1 << 20,
        };
        let path = folder.path().join("r.mcap");
        Parts::new(path, limits, Preamble::default()).unwrap()
    }

    fn opened(folder: &TempDir, name: &str) -> Recording {
        let recording = Recording::open(folder.path().join(name)).unwrap();
        assert_eq!(recording.damage(), None, "{name}");
        recording
    }

    #[test]
    fn parts_by_time_each_begin_with_what_is_latched() {
        let folder = TempDir::new().unwrap();
        let mut parts = parts(&folder, None, Some(10));
        parts.put(message(MAP, 0, true)).unwrap();
        for second in [0, 9, 10, 11, 35] {
            parts.put(message("/n", second, false)).unwrap();
        }
        parts.finish().unwrap();
        assert_eq!((parts.tally().files, parts.tally().recorded), (3, 6));
        let named = |name: &str, second| (name.to_owned(), second);
        let expected = [
            vec![named(MAP, 0), named("/n", 0), named("/n", 9)],
            vec![named(MAP, 10), named("/n", 10), named("/n", 11)],
            vec![named(MAP, 35), named("/n", 35)],
        ];
        for (number, expected) in expected.iter().enumerate() {
            assert_eq!(
                topics(&opened(&folder, &format!("r_{number}.mcap"))),
                *expected
            );
        }
    }

    #[test]
    fn parts_by_size_end_with_the_flush_that_fills_them() {
        let folder = TempDir::new().unwrap();
        let mut parts = parts(&folder, Some(5000), None);
        for second in 0..9 {
            parts.put(message("/n", second, false)).unwrap();
            parts.flush().unwrap();
        }
        parts.finish().unwrap();
        let files = parts.tally().files;
        assert!(files > 1);
        let all: u64 = (0..files)
            .map(|n| opened(&folder, &format!("r_{n}.mcap")).messages())
            .sum();
        assert_eq!(all, 9);
    }

    #[test]
    fn all_parts_are_synced_and_only_the_last_one_again() {
        let folder = TempDir::new().unwrap();
        let mut parts = parts(&folder, None, Some(10));
        for second in [0, 11, 22] {
            parts.put(message("/n", second, false)).unwrap();
        }
        assert_eq!(parts.unsynced.len(), 3);
        parts.sync().unwrap();
        let names: Vec<_> = parts.unsynced.iter().map(|(path, _)| path).collect();
        assert_eq!(names, [&folder.path().join("r_2.mcap")]);
        parts.finish().unwrap();
        parts.sync().unwrap();
        assert!(parts.unsynced.is_empty());
    }

    #[test]
    fn a_part_that_could_not_be_ended_is_followed_by_another() {
        let folder = TempDir::new().unwrap();
        let mut parts = parts(&folder, None, Some(10));
        parts.put(message(MAP, 0, true)).unwrap();
        parts.part = None;
        parts.put(message("/n", 1, false)).unwrap();
        parts.finish().unwrap();
        assert_eq!(parts.tally().files, 2);
        assert_eq!(opened(&folder, "r_1.mcap").messages(), 2, "with the map");
    }

    #[test]
    fn what_does_not_fit_into_memory_is_dropped_and_counted() {
        let folder = TempDir::new().unwrap();
        let mut parts = parts(&folder, None, None);
        parts.limits.waiting_bytes = 0;
        parts.put(message("/n", 1, false)).unwrap();
        // The beginning of the chunk is already waiting.
        parts.put(message("/n", 2, false)).unwrap();
        parts.flush().unwrap();
        parts.put(message("/n", 3, false)).unwrap();
        parts.finish().unwrap();
        assert_eq!((parts.tally().recorded, parts.tally().dropped), (2, 1));
        assert_eq!(opened(&folder, "r.mcap").messages(), 2);
    }
}
