//! Where entries go: to files at once, or to a black box.

use ros_export::Entry;

use super::{BlackBox, Parts, Tally};
use crate::RecorderError;

/// One of the two ways to record.
pub(crate) enum Store {
    Parts(Box<Parts>),
    BlackBox(Box<BlackBox>),
}

impl Store {
    /// Takes an entry; returns whether there was room.
    ///
    /// # Errors
    /// If it cannot be written for another reason than a full disk.
    pub(crate) fn put(&mut self, entry: Entry) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.put(&entry),
            Store::BlackBox(black_box) => black_box.put(entry),
        }
    }

    /// Brings to the disk what is there.
    ///
    /// # Errors
    /// If the disk does not take it; it is kept and tried again.
    pub(crate) fn flush(&mut self) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.flush(),
            Store::BlackBox(_) => Ok(()),
        }
    }

    /// Waits until the disk has what was flushed, so that a loss of power does not take it.
    /// A black box is on the disk once it is saved.
    ///
    /// # Errors
    /// If the disk does not take it.
    pub(crate) fn sync(&mut self) -> Result<(), RecorderError> {
        match self {
            Store::Parts(parts) => parts.sync(),
            Store::BlackBox(_) => Ok(()),
        }
    }

    /// Saves a black box; nothing for files, which are saved already.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn save(&mut self, why: &str) -> Result<(), RecorderError> {
        match self {
            Store::Parts(_) => Ok(()),
            Store::BlackBox(black_box) => black_box.save(why),
        }
    }

    /// Saves a black box because something happened, at once or with what happens next.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn happened(&mut self, event: &str) -> Result<(), RecorderError> {
        match self {
            Store::Parts(_) => Ok(()),
            Store::BlackBox(black_box) => black_box.happened(event),
        }
    }

    /// Ends the file, or saves what events still wait for.
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
