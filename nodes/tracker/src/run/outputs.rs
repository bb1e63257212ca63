//! What the node publishes.

use messages::{AttentionHeader, PoseHeader, Stamp, topic};
use transport::{Graph, Peers, Publisher, TransportError, monotonic_ns};

/// The node's publishers.
pub(super) struct Outputs {
    poses: Publisher<topic::Tracked>,
    attention: Publisher<topic::Attention>,
    /// Most poses a second that odometry carries on.
    rate: f64,
    /// When the last pose was sent.
    sent_ns: i64,
}

impl Outputs {
    pub(super) fn open(graph: &Graph, rate: f64) -> Result<Self, TransportError> {
        Ok(Outputs {
            poses: graph.publisher_for(PoseHeader::WORDS_CAPACITY)?,
            attention: graph.publisher()?,
            rate,
            sent_ns: 0,
        })
    }

    /// Those who get what is asked for.
    pub(super) fn asked(&self) -> Peers {
        self.attention.subscribers()
    }

    /// Asks for a search of a scan.
    pub(super) fn ask(&self, stamp: Stamp) -> Result<(), TransportError> {
        let mut loan = self.attention.loan(0)?;
        *loan.header_mut() = AttentionHeader { stamp };
        loan.send()
    }

    /// Whether a pose that odometry carried on may be sent now.
    pub(super) fn is_due(&self) -> bool {
        let since_ns = monotonic_ns() - self.sent_ns;
        self.rate > 0.0 && since_ns as f64 >= 1e9 / self.rate
    }

    /// Sends a pose, with the reason in words.
    pub(super) fn pose(
        &mut self,
        mut header: PoseHeader,
        words: &str,
    ) -> Result<(), TransportError> {
        let mut loan = self.poses.loan(words.len())?;
        loan.items_mut().copy_from_slice(words.as_bytes());
        header.sent_ns = monotonic_ns();
        self.sent_ns = header.sent_ns;
        *loan.header_mut() = header;
        loan.send()
    }
}
