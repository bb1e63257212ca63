//! Destination of entries: files, or a black box.

use ros_export::Entry;

use super::{BlackBox, Parts, Tally};
use crate::RecorderError;

/// One of the two ways to record.
pub(crate) enum Store {
    Parts(Box<Parts>),
    BlackBox(Box<BlackBox>),
}

impl Store {
    /// Stores an entry.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn put(&mut self, entry: Entry) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.put(&entry),
            Store::BlackBox(black_box) => black_box.put(entry),
        }
    }

    /// Writes buffered data to the disk.
    ///
    /// # Errors
    /// If the disk does not take it; it is kept and retried.
    pub(crate) fn flush(&mut self) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.flush(),
            Store::BlackBox(_) => Ok(()),
        }
    }

    /// Syncs flushed data to the disk, so that it survives a power failure. A black box is synced
    /// when it is saved.
    ///
    /// # Errors
    /// If syncing fails.
    pub(crate) fn sync(&mut self) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.sync(),
            Store::BlackBox(_) => Ok(()),
        }
    }

    /// Saves a black box; does nothing for files, which are already saved.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(crate) fn save(&mut self, why: &str) -> Result<(), RecorderError> {
        match self {
            Store::Parts(_) => Ok(()),
            Store::BlackBox(black_box) => black_box.save(why),
        }
    }

    /// Saves a black box because of an event, at once or together with later events.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(crate) fn happened(&mut self, event: &str) -> Result<(), RecorderError> {
        match self {
            Store::Parts(_) => Ok(()),
            Store::BlackBox(black_box) => black_box.happened(event),
        }
    }

    /// Finishes the file, or saves the black box for unsaved events.
    ///
    /// # Errors
    /// If the disk does not take the rest.
    pub(crate) fn finish(&mut self) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.finish(),
            Store::BlackBox(black_box) => black_box.save_events(),
        }
    }

    pub(crate) fn tally(&self) -> Tally {
        match self {
            Store::Parts(parts) => parts.tally(),
            Store::BlackBox(black_box) => black_box.tally(),
        }
    }
}
