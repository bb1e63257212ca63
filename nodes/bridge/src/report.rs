//! What the bridge says of itself.
//!
//! Strangers decide how much is refused, so it is counted always and said now and
//! then.

use messages::NodeState;
use transport::{Health, TransportError, monotonic_ns, with_causes};

use crate::BridgeError;

/// Between two refusals that are put into words, nanoseconds.
const QUIET_NS: i64 = 1_000_000_000;

/// Counts, and says what is wrong.
pub(crate) struct Report {
    health: Health,
    said_ns: i64,
    /// Refusals that were counted and not put into words.
    unsaid: u64,
}

impl Report {
    pub(crate) fn new(health: Health) -> Self {
        Report {
            health,
            said_ns: i64::MIN / 2,
            unsaid: 0,
        }
    }

    pub(crate) fn ready(&mut self) -> Result<(), TransportError> {
        self.health.state(NodeState::Ready)
    }

    pub(crate) fn tick(&mut self) -> Result<(), TransportError> {
        self.health.tick()
    }

    pub(crate) fn received(&mut self) {
        self.health.count_received(1);
    }

    pub(crate) fn sent(&mut self) {
        self.health.count_sent(1);
    }

    pub(crate) fn dropped(&mut self, messages: u64) {
        self.health.count_dropped(messages);
    }

    /// A message was refused.
    pub(crate) fn refused(&mut self, error: &BridgeError) -> Result<(), TransportError> {
        self.health.count_refused(1);
        let now_ns = monotonic_ns();
        if now_ns - self.said_ns < QUIET_NS {
            self.unsaid += 1;
            return Ok(());
        }
        let unsaid = std::mem::take(&mut self.unsaid);
        self.said_ns = now_ns;
        let problem = with_causes(error);
        tracing::warn!(unsaid, "refused: {problem}");
        self.health.error(&problem)
    }
}
