//! The quality of service of a topic.

/// Reliability and durability of a topic, in the words of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeping {
    /// Best effort, volatile: for sensors.
    Fresh,
    /// Reliable, volatile.
    Reliable,
    /// Reliable, transient local: late subscribers get the last messages of each sender.
    Kept,
}
