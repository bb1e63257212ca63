//! Health of a node.

use crate::Name;

crate::message! {
    #[type_name("HealthHeader/v1")]
    /// Header of topic `health`; the items are the last error as UTF-8, at most
    /// [`HealthHeader::ERROR_CAPACITY`] bytes, empty without an error.
    #[derive(Eq)]
    pub struct HealthHeader {
        /// Name of the node.
        pub node: Name,
        /// `CLOCK_MONOTONIC` in nanoseconds when it was sent.
        pub sent_ns: i64,
        /// Number of samples received from inputs.
        pub received: u64,
        /// Number of samples sent.
        pub sent: u64,
        /// Number of samples lost before they were received, because the node was too slow, or not
        /// sent, because shared memory was full.
        pub dropped: u64,
        /// Number of received samples that were rejected as unusable.
        pub refused: u64,
        /// Process id of the node.
        pub pid: u32,
        /// State of the node, a [`NodeState`].
        pub state: u32,
    }
}

impl HealthHeader {
    /// Longest last error in bytes.
    pub const ERROR_CAPACITY: usize = 1024;
}

crate::codes! {
    /// State of a node.
    pub enum NodeState: u32 {
        /// Running, but without something it needs: a map, a boundary, a device.
        Waiting = 0 => "waiting",
        /// Able to answer its inputs.
        Ready = 1 => "ready",
        /// Works, but not as it should; the last error says why.
        Degraded = 2 => "degraded",
        /// About to end.
        Stopped = 3 => "stopped",
        /// Busy with work that may take longer than the report interval; it does not answer meanwhile.
        Busy = 4 => "busy",
    }
}
