//! Counters of a recording.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Tally {
    /// Number of messages in a file or on the way to it.
    pub(crate) recorded: u64,
    /// Number of messages lost because they arrived faster than they could be written.
    pub(crate) dropped: u64,
    pub(crate) files: u64,
}
