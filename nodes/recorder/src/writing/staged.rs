//! File that is written in whole steps; data between two flushes stays in memory.
//!
//! If the disk takes only part of a step, the file is truncated to the previous step, so that it
//! always ends with a whole chunk, and the step is retried later. A process that is killed loses
//! the data since the last flush.

use std::fs::File;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::os::unix::fs::FileExt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Number of bytes waiting in memory and number in total; shared, because the writer owns the file.
#[derive(Debug, Default)]
pub(super) struct Progress {
    waiting: AtomicUsize,
    all: AtomicU64,
}

impl Progress {
    pub(super) fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    pub(super) fn all(&self) -> u64 {
        self.all.load(Ordering::Relaxed)
    }

    fn set(&self, waiting: usize, written: u64) {
        self.waiting.store(waiting, Ordering::Relaxed);
        self.all.store(written + waiting as u64, Ordering::Relaxed);
    }
}

#[derive(Debug)]
pub(super) struct Staged<F = File> {
    file: F,
    written: u64,
    step: Cursor<Vec<u8>>,
    progress: Arc<Progress>,
}

/// File operations; a trait for tests.
pub(super) trait Storage {
    fn write_all_at(&self, bytes: &[u8], at: u64) -> io::Result<()>;
    fn cut(&self, length: u64) -> io::Result<()>;
}

impl Storage for File {
    fn write_all_at(&self, bytes: &[u8], at: u64) -> io::Result<()> {
        FileExt::write_all_at(self, bytes, at)
    }

    fn cut(&self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }
}

impl<F: Storage> Staged<F> {
    pub(super) fn new(file: F, progress: Arc<Progress>) -> Self {
        Staged {
            file,
            written: 0,
            step: Cursor::default(),
            progress,
        }
    }
}

impl<F: Storage> Write for Staged<F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let length = self.step.write(bytes)?;
        self.progress.set(self.step.get_ref().len(), self.written);
        Ok(length)
    }

    fn flush(&mut self) -> io::Result<()> {
        if let Err(error) = self.file.write_all_at(self.step.get_ref(), self.written) {
            // If truncating fails as well, readers find a truncated last chunk.
            let _ = self.file.cut(self.written);
            return Err(error);
        }
        self.written += self.step.get_ref().len() as u64;
        self.step.get_mut().clear();
        self.step.set_position(0);
        self.progress.set(0, self.written);
        Ok(())
    }
}

impl<F: Storage> Seek for Staged<F> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let to = match to {
            SeekFrom::Start(at) => {
                let written = || io::Error::other("what is on the disk already cannot be changed");
                SeekFrom::Start(at.checked_sub(self.written).ok_or_else(written)?)
            }
            SeekFrom::Current(_) | SeekFrom::End(_) => to,
        };
        Ok(self.written + self.step.seek(to)?)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};
    use std::rc::Rc;

    use recording::Recording;
    use recording::write::{Packing, RecordingWriter};

    use super::*;

    /// Disk with room for this many bytes; what does not fit is written partly.
    #[derive(Debug, Clone, Default)]
    struct SmallDisk {
        bytes: Rc<RefCell<Vec<u8>>>,
        room: Rc<Cell<usize>>,
    }

    impl Storage for SmallDisk {
        fn write_all_at(&self, bytes: &[u8], at: u64) -> io::Result<()> {
            let mut all = self.bytes.borrow_mut();
            assert_eq!(all.len() as u64, at);
            let fits = bytes.len().min(self.room.get().saturating_sub(all.len()));
            all.extend(&bytes[..fits]);
            match fits == bytes.len() {
                true => Ok(()),
                false => Err(io::Error::from(io::ErrorKind::StorageFull)),
            }
        }

        fn cut(&self, length: u64) -> io::Result<()> {
            self.bytes.borrow_mut().truncate(length as usize);
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_keeps_whole_chunks_and_nothing_is_lost_once_there_is_room() {
        let disk = SmallDisk::default();
        disk.room.set(1000);
        let progress = Arc::new(Progress::default());
        let sink = Staged::new(disk.clone(), Arc::clone(&progress));
        let mut writer = RecordingWriter::new(sink, Packing::Zstd).unwrap();
        let mut refused = 0;
        for number in 0..100i64 {
            let body = number.to_le_bytes();
            writer
                .write_bytes("/n", "n", "int64 n", "cdr", number, &body)
                .unwrap();
            match writer.flush() {
                Ok(()) => assert_eq!(progress.waiting(), 0),
                Err(error) => {
                    assert!(error.to_string().contains("no storage space"), "{error}");
                    assert!(progress.waiting() > 0);
                    refused += 1;
                }
            }
            let so_far = Recording::from_bytes("r.mcap", disk.bytes.borrow().clone()).unwrap();
            assert_eq!(so_far.messages() + refused, number as u64 + 1);
        }
        assert!((1..100).contains(&refused));
        disk.room.set(usize::MAX);
        writer.finish().unwrap().flush().unwrap();
        let whole = Recording::from_bytes("r.mcap", disk.bytes.borrow().clone()).unwrap();
        assert_eq!((whole.messages(), whole.damage()), (100, None));
        assert_eq!(progress.all(), disk.bytes.borrow().len() as u64);
    }

    #[test]
    fn what_is_on_the_disk_is_never_changed() {
        let disk = SmallDisk::default();
        disk.room.set(usize::MAX);
        let mut staged = Staged::new(disk.clone(), Arc::default());
        staged.write_all(b"abcd").unwrap();
        staged.seek(SeekFrom::Start(1)).unwrap();
        staged.write_all(b"X").unwrap();
        staged.seek(SeekFrom::End(0)).unwrap();
        staged.flush().unwrap();
        assert_eq!(*disk.bytes.borrow(), b"aXcd");
        assert!(staged.seek(SeekFrom::Start(3)).is_err());
        assert!(staged.seek(SeekFrom::Current(-1)).is_err());
        assert_eq!(staged.stream_position().unwrap(), 4);
    }
}
