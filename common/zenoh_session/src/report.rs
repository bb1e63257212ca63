//! Health of a node that joins a network.
//!
//! Remote senders decide how much is rejected, so rejections are always counted but logged at a
//! limited rate.

use std::error::Error;

use messages::{HealthHeader, NodeState};
use transport::{ErrorLimit, Health, TransportError, monotonic_ns, with_causes};

/// Counts messages and reports problems.
#[derive(Debug)]
pub struct Report {
    health: Health,
    error_limit: ErrorLimit,
    /// Text for what is waited for; `None` if everything needed is there.
    waiting: Option<String>,
    /// True if this text is the last error in health.
    is_said: bool,
    /// True if the last map was rejected.
    is_map_refused: bool,
}

impl Report {
    pub fn new(health: Health) -> Self {
        Report {
            health,
            error_limit: ErrorLimit::default(),
            waiting: Some(String::new()),
            is_said: false,
            is_map_refused: false,
        }
    }

    /// Reports that everything needed is there.
    pub fn ready(&mut self) -> Result<(), TransportError> {
        self.is_map_refused = false;
        self.waiting_for(None)
    }

    /// Reports what is waited for, as words after "waiting for"; empty if it is too early to say,
    /// `None` if everything needed is there. The words are the last error in health while they
    /// hold.
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

    /// Reports that a map was accepted, which ends the state after a rejected one.
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

    /// Publishes health when due; to be called regularly.
    pub fn tick(&mut self) -> Result<(), TransportError> {
        self.health.tick()
    }

    pub fn received(&mut self) {
        self.health.count_received(1);
    }

    pub fn sent(&mut self) {
        self.health.count_sent(1);
    }

    /// Counts a message as sent, or reports why it was not.
    pub fn outcome(
        &mut self,
        sent: Result<(), impl Error + 'static>,
    ) -> Result<(), TransportError> {
        match sent {
            Ok(()) => self.sent(),
            Err(error) => self.refused(&error)?,
        }
        Ok(())
    }

    pub fn dropped(&mut self, messages: u64) {
        self.health.count_dropped(messages);
    }

    /// Reports a rejected map; the previous one stays in use.
    pub fn map_refused(&mut self, error: &(dyn Error + 'static)) -> Result<(), TransportError> {
        self.refused(error)?;
        self.is_map_refused = true;
        self.health.state(self.state())
    }

    /// Counts a rejected message, and logs it unless one was logged just before.
    pub fn refused(&mut self, error: &(dyn Error + 'static)) -> Result<(), TransportError> {
        self.health.count_refused(1);
        let Some(unsaid) = self.error_limit.note(monotonic_ns()) else {
            return Ok(());
        };
        // Remote senders influence the text, too.
        let mut problem = with_causes(error);
        problem.truncate(problem.floor_char_boundary(HealthHeader::ERROR_CAPACITY));
        tracing::warn!(unsaid, "rejected: {problem}");
        self.is_said = false;
        self.health.error(&problem)
    }
}
