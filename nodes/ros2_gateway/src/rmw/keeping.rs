//! The quality of service of a topic.

/// Which messages a topic has for those who come late, in the words of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeping {
    /// Best effort, volatile: sensors.
    Fresh,
    /// Reliable, volatile.
    Reliable,
    /// Reliable, transient local: the last of each sender is there.
    Kept,
}
