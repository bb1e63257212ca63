//! The last minutes in memory, saved when somebody asks for them.
//!
//! The disk is not touched before. What is older than asked for, or more than
//! the memory allows, is forgotten; what a reader must know of it (the map, the
//! mounts) is kept for the head of the file.

use std::collections::VecDeque;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::time::Duration;

use recording::write::{Packing, RecordingWriter};
use ros_export::Entry;

use super::{Preamble, Tally, name};
use crate::RecorderError;

/// What a message takes beside its bytes.
const OVERHEAD_BYTES: usize = 128;

pub(crate) struct BlackBox {
    path: PathBuf,
    keep: Duration,
    capacity_bytes: usize,
    preamble: Preamble,
    kept: VecDeque<Entry>,
    bytes: usize,
    newest_ns: i64,
    tally: Tally,
}

impl BlackBox {
    /// An empty one, of which saved files are called after `path`.
    pub(crate) fn new(
        path: PathBuf,
        keep: Duration,
        capacity_bytes: usize,
        preamble: Preamble,
    ) -> Self {
        BlackBox {
            path,
            keep,
            capacity_bytes,
            preamble,
            kept: VecDeque::new(),
            bytes: 0,
            newest_ns: 0,
            tally: Tally::default(),
        }
    }

    pub(super) fn put(&mut self, entry: Entry) {
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
    }

    /// Writes what is kept, which continues to be kept.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(super) fn save(&mut self, why: &str) -> Result<(), RecorderError> {
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
        // It is saved when a loss of power does not take it.
        file.flush()
            .and_then(|()| file.get_ref().sync_data())
            .map_err(|source| RecorderError::Save {
                path: path.clone(),
                source,
            })?;
        self.tally.files += 1;
        tracing::info!("{why}: saved to {}", path.display());
        Ok(())
    }

    pub(super) fn tally(&self) -> Tally {
        self.tally
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

fn size(entry: &Entry) -> usize {
    match entry {
        Entry::Message(message) => message.body.len() + OVERHEAD_BYTES,
        Entry::Metadata(..) => OVERHEAD_BYTES,
    }
}

#[cfg(test)]
mod tests {
    use recording::write::Encoded;
    use recording::{MAP, Recording};
    use tempfile::TempDir;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    fn message(topic: &'static str, second: i64, latched: bool) -> Entry {
        Entry::Message(Encoded {
            topic: topic.into(),
            schema: "n",
            definition: "int64 n",
            latched,
            log_time_ns: second * SECOND,
            body: vec![7; 1000],
        })
    }

    fn saved(folder: &TempDir, name: &str) -> Vec<(String, i64)> {
        let recording = Recording::open(folder.path().join(name)).unwrap();
        assert_eq!(recording.damage(), None);
        assert_eq!(recording.metadata()[0].entries["reason"], "asked");
        let records = recording.raw_records().map(Result::unwrap);
        records
            .map(|r| (r.channel.topic.to_string(), r.log_time_ns / SECOND))
            .collect()
    }

    fn black_box(folder: &TempDir, keep_s: u64, capacity_bytes: usize) -> BlackBox {
        let path = folder.path().join("r.mcap");
        let keep = Duration::from_secs(keep_s);
        BlackBox::new(path, keep, capacity_bytes, Preamble::empty())
    }

    #[test]
    fn the_last_seconds_are_saved_with_the_map_from_before() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 3, 1 << 20);
        black_box.put(message(MAP, 0, true));
        for second in 0..10 {
            black_box.put(message("/n", second, false));
        }
        assert!(!folder.path().join("r.mcap").exists());
        black_box.save("asked").unwrap();
        let topics = |times: &[i64]| -> Vec<(String, i64)> {
            let map = (MAP.to_owned(), times[0]);
            let rest = times.iter().map(|time| ("/n".to_owned(), *time));
            [map].into_iter().chain(rest).collect()
        };
        assert_eq!(saved(&folder, "r.mcap"), topics(&[6, 7, 8, 9]));
        black_box.put(message("/n", 10, false));
        black_box.save("asked").unwrap();
        assert_eq!(saved(&folder, "r_1.mcap"), topics(&[7, 8, 9, 10]));
        assert_eq!(black_box.tally().files, 2);
    }

    #[test]
    fn memory_is_bounded() {
        let folder = TempDir::new().unwrap();
        let mut black_box = black_box(&folder, 1000, 3 * 1128);
        for second in 0..10 {
            black_box.put(message("/n", second, false));
        }
        assert_eq!((black_box.kept.len(), black_box.bytes), (3, 3 * 1128));
    }
}
