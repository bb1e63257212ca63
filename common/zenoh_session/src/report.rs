//! What a node that joins a network says of itself.
//!
//! Strangers decide how much is refused, so it is counted always and said now and
//! then.

use std::error::Error;

use messages::{HealthHeader, NodeState};
use transport::{Health, TransportError, monotonic_ns, with_causes};

/// Between two refusals that are reported, nanoseconds.
const QUIET_NS: i64 = 1_000_000_000;

/// Counts, and says what is wrong.
#[derive(Debug)]
pub struct Report {
    health: Health,
    said_ns: i64,
    /// Refusals that were counted and not reported.
    unsaid: u64,
}

impl Report {
    /// Reports by `health`.
    #[must_use]
    pub fn new(health: Health) -> Self {
        Report {
            health,
            said_ns: i64::MIN / 2,
            unsaid: 0,
        }
    }

    /// All that is needed is there.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn ready(&mut self) -> Result<(), TransportError> {
        self.health.state(NodeState::Ready)
    }

    /// To be called now and then.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn tick(&mut self) -> Result<(), TransportError> {
        self.health.tick()
    }

    /// A message came.
    pub fn received(&mut self) {
        self.health.count_received(1);
    }

    /// A message went.
    pub fn sent(&mut self) {
        self.health.count_sent(1);
    }

    /// This many messages were lost.
    pub fn dropped(&mut self, messages: u64) {
        self.health.count_dropped(messages);
    }

    /// A map was refused, and the one before stays.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn map_refused(&mut self, error: &(dyn Error + 'static)) -> Result<(), TransportError> {
        self.refused(error)?;
        self.health.state(NodeState::Degraded)
    }

    /// A message was refused.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn refused(&mut self, error: &(dyn Error + 'static)) -> Result<(), TransportError> {
        self.health.count_refused(1);
        let now_ns = monotonic_ns();
        if now_ns - self.said_ns < QUIET_NS {
            self.unsaid += 1;
            return Ok(());
        }
        let unsaid = std::mem::take(&mut self.unsaid);
        self.said_ns = now_ns;
        // Strangers decide what stands in it, too.
        let mut problem = with_causes(error);
        problem.truncate(problem.floor_char_boundary(HealthHeader::ERROR_CAPACITY));
        tracing::warn!(unsaid, "rejected: {problem}");
        self.health.error(&problem)
    }
}
