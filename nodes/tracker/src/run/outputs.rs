//! Publishers of the node.

use messages::{AttentionHeader, PoseHeader, Stamp, topic};
use transport::{Graph, Peers, Publisher, TransportError, monotonic_ns};

pub(super) struct Outputs {
    poses: Publisher<topic::Tracked>,
    attention: Publisher<topic::Attention>,
    rate: f64,
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

    pub(super) fn asked(&self) -> Peers {
        self.attention.subscribers()
    }

    pub(super) fn ask(&self, stamp: Stamp) -> Result<(), TransportError> {
        self.attention.send(AttentionHeader { stamp }, &[])
    }

    pub(super) fn is_due(&self) -> bool {
        let since_ns = monotonic_ns() - self.sent_ns;
        self.rate > 0.0 && since_ns as f64 >= 1e9 / self.rate
    }

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
