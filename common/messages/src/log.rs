//! A line of a node's log.

use crate::Name;

crate::message! {
    #[type_name("LogHeader/v1")]
    /// Header of topic `log`; the items are the line as UTF-8 without a newline, at most
    /// [`LogHeader::TEXT_CAPACITY`] bytes.
    #[derive(Eq)]
    pub struct LogHeader {
        /// Name of the node.
        pub node: Name,
        /// `CLOCK_MONOTONIC` in nanoseconds when it was written.
        pub written_ns: i64,
        /// Wall clock in nanoseconds since 1970 when it was written.
        pub wall_ns: i64,
        /// Number of the line in its process, from 0; gaps show losses.
        pub counter: u64,
        /// Number of lines of the process that were lost before they could be sent, because they
        /// were logged faster than sent.
        pub dropped: u64,
        /// Level of the line, a [`LogLevel`].
        pub level: u32,
        /// Process id of the node.
        pub pid: u32,
    }
}

impl LogHeader {
    /// Longest line in bytes; longer ones are cut at a character boundary.
    pub const TEXT_CAPACITY: usize = 1024;
}

crate::codes! {
    /// Severity of a line, with the codes of `rcl_interfaces/Log`.
    #[derive(PartialOrd, Ord)]
    pub enum LogLevel: u32 {
        /// Useful to developers.
        Debug = 10,
        /// Normal operation.
        Info = 20,
        /// A problem with which the node continues.
        Warn = 30,
        /// The node cannot do its task.
        Error = 40,
    }
}
