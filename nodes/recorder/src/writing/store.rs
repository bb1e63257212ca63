//! Destination of entries: files, or a black box.

use ros_graph::export::Entry;

use crate::RecorderError;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Tally {
    /// Number of messages in a file or on the way to it.
    pub(crate) recorded: u64,
    /// Number of messages lost because they arrived faster than they could be written.
    pub(crate) dropped: u64,
    pub(crate) files: u64,
}

/// One of the two ways to record; what one of them does not need does nothing.
pub(crate) trait Store: Send {
    /// Adds an entry; an error says why the disk does not take it.
    fn put(&mut self, entry: Entry) -> Result<(), RecorderError>;

    /// Writes buffered data to the disk; what it does not take is kept and retried.
    fn flush(&mut self) -> Result<(), RecorderError> {
        Ok(())
    }

    /// Syncs flushed data to the disk, so that it survives a power failure. A black box is synced
    /// when it is saved.
    fn sync(&mut self) -> Result<(), RecorderError> {
        Ok(())
    }

    fn save(&mut self, _why: &str) -> Result<(), RecorderError> {
        Ok(())
    }

    /// Saves a black box because of an event: at once, or once the file no longer overlaps the last
    /// one.
    fn happened(&mut self, _event: &str) -> Result<(), RecorderError> {
        Ok(())
    }

    /// Finishes the file, or saves the black box for unsaved events.
    fn finish(&mut self) -> Result<(), RecorderError>;

    fn tally(&self) -> Tally;
}
