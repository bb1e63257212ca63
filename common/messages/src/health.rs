//! The state of a node.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Name;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `health`; the items are the last error as UTF-8, at most
/// [`HealthHeader::ERROR_CAPACITY`] bytes, empty where there was none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("HealthHeader/v1")
)]
#[repr(C)]
pub struct HealthHeader {
    /// The node's name.
    pub node: Name,
    /// `CLOCK_MONOTONIC` in nanoseconds when it was sent.
    pub sent_ns: i64,
    /// Samples taken from inputs.
    pub received: u64,
    /// Samples sent.
    pub sent: u64,
    /// Samples lost before they could be taken, because the node was too slow, or that
    /// could not be sent, because shared memory was full.
    pub dropped: u64,
    /// Samples taken and refused as unusable.
    pub refused: u64,
    /// The node's process.
    pub pid: u32,
    /// A [`NodeState`].
    pub state: u32,
}

impl HealthHeader {
    /// Most bytes of the last error.
    pub const ERROR_CAPACITY: usize = 1024;
}

/// What a node is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum NodeState {
    /// Up, but what it needs has not come yet: a map, a boundary, a device.
    Waiting = 0,
    /// Able to answer its inputs.
    Ready = 1,
    /// Works, but not as it should; the last error says why.
    Degraded = 2,
    /// About to end.
    Stopped = 3,
    /// At work on something that may take longer than reports are apart; it answers
    /// nothing meanwhile.
    Busy = 4,
}

impl NodeState {
    /// As users read it.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Ready => "ready",
            Self::Degraded => "degraded",
            Self::Stopped => "stopped",
            Self::Busy => "busy",
        }
    }

    /// The state with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [
            Self::Waiting,
            Self::Ready,
            Self::Degraded,
            Self::Stopped,
            Self::Busy,
        ]
        .into_iter()
        .find(|s| *s as u32 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(HealthHeader, size 80, align 8, {
        node: 0, sent_ns: 32, received: 40, sent: 48, dropped: 56, refused: 64, pid: 72, state: 76,
    });
}
