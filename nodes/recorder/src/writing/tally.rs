//! Counts of what was recorded.

/// What was done so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Tally {
    /// Messages that are in a file, or on the way to it.
    pub(crate) recorded: u64,
    /// Messages that are lost because they arrived faster than they could be
    /// written.
    pub(crate) dropped: u64,
    /// Files begun.
    pub(crate) files: u64,
}
