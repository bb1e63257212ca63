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
    /// What is waited for, in words; none where all that is needed is there.
    waiting: Option<String>,
    /// Whether those words are the last error.
    is_said: bool,
    /// Whether the last map was refused.
    is_map_refused: bool,
}

impl Report {
    /// Reports by `health`.
    #[must_use]
    pub fn new(health: Health) -> Self {
        Report {
            health,
            said_ns: i64::MIN / 2,
            unsaid: 0,
            waiting: Some(String::new()),
            is_said: false,
            is_map_refused: false,
        }
    }

    /// All that is needed is there.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn ready(&mut self) -> Result<(), TransportError> {
        self.is_map_refused = false;
        self.waiting_for(None)
    }

    /// What is waited for, in words that stand behind "waiting for"; empty where it is too
    /// early to say, none where all that is needed is there. The words stand as the last
    /// error for as long as they hold.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn waiting_for(&mut self, words: Option<&str>) -> Result<(), TransportError> {
        if self.waiting.as_deref() != words {
            self.waiting = words.map(str::to_owned);
            match words {
                Some(words) if !words.is_empty() => {
                    self.is_said = true;
                    self.health.error(&format!("waiting for {words}"))?;
                }
                _ if std::mem::take(&mut self.is_said) => self.health.forget_error(),
                _ => {}
            }
        }
        self.health.state(self.state())
    }

    /// A map was taken: one that was refused before is no more what is wanted.
    ///
    /// # Errors
    /// If the graph fails.
    pub fn map_taken(&mut self) -> Result<(), TransportError> {
        self.is_map_refused = false;
        self.health.state(self.state())
    }

    fn state(&self) -> NodeState {
        match &self.waiting {
            _ if self.is_map_refused => NodeState::Degraded,
            Some(_) => NodeState::Waiting,
            None => NodeState::Ready,
        }
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
        self.is_map_refused = true;
        self.health.state(self.state())
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
        self.is_said = false;
        self.health.error(&problem)
    }
}
