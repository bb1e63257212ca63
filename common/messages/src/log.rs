//! A line of a node's log.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Name;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `log`; the items are the line as UTF-8 without its end, at
/// most [`LogHeader::TEXT_CAPACITY`] bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("LogHeader/v1"))]
#[repr(C)]
pub struct LogHeader {
    /// The node's name.
    pub node: Name,
    /// `CLOCK_MONOTONIC` in nanoseconds when it was written.
    pub written_ns: i64,
    /// Nanoseconds since 1970 on the host's clock when it was written.
    pub wall_ns: i64,
    /// Counts up by one from 0 in each process, so that gaps show losses.
    pub counter: u64,
    /// Lines of the process that were lost before they could be sent: it wrote
    /// faster than it looked after its topics.
    pub dropped: u64,
    /// A [`LogLevel`].
    pub level: u32,
    /// The node's process.
    pub pid: u32,
}

impl LogHeader {
    /// Most bytes of a line; longer ones are cut between characters.
    pub const TEXT_CAPACITY: usize = 1024;
}

/// How grave a line is, with the numbers of `rcl_interfaces/Log`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum LogLevel {
    /// Of use to developers.
    Debug = 10,
    /// As it should be.
    Info = 20,
    /// Not as it should be, but the node continues.
    Warn = 30,
    /// The node cannot do what it is there for.
    Error = 40,
}

impl LogLevel {
    /// The level with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [Self::Debug, Self::Info, Self::Warn, Self::Error]
            .into_iter()
            .find(|level| *level as u32 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(LogHeader, size 72, align 8, {
        node: 0, written_ns: 32, wall_ns: 40, counter: 48, dropped: 56, level: 64, pid: 68,
    });

    #[test]
    fn codes_name_their_level() {
        assert_eq!(LogLevel::from_code(40), Some(LogLevel::Error));
        assert_eq!(LogLevel::from_code(50), None);
    }
}
