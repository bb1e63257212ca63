//! Reports a node's health, as the node sets it.

use std::cell::RefCell;
use std::rc::Rc;

use messages::topic;
use messages::{HealthHeader, Name, NodeState};

use crate::log_sender::LogSender;
use crate::losses::Losses;
use crate::{Publisher, TransportError, monotonic_ns, with_causes};

const PERIOD_NS: i64 = 1_000_000_000;

/// Counts what a node does and publishes it on topic `health`.
#[derive(Debug)]
pub struct Health {
    publisher: Publisher<topic::Health>,
    report: HealthHeader,
    last_error: String,
    /// Lost samples of all publishers of the process, because shared memory was full.
    losses: Losses,
    losses_reported: u64,
    /// Log sender of the node, for nodes that do not use [`crate::Graph::run`].
    log: Option<Rc<RefCell<LogSender>>>,
}

impl Health {
    pub(crate) fn new(
        node: &str,
        publisher: Publisher<topic::Health>,
        losses: Losses,
        log: Option<Rc<RefCell<LogSender>>>,
    ) -> Result<Self, TransportError> {
        let mut health = Health {
            publisher,
            report: HealthHeader {
                node: Name::new(node),
                pid: std::process::id(),
                state: NodeState::Waiting as u32,
                ..bytemuck::Zeroable::zeroed()
            },
            last_error: String::new(),
            losses,
            losses_reported: 0,
            log,
        };
        health.send()?;
        Ok(health)
    }

    /// Counts samples received from inputs.
    pub fn count_received(&mut self, samples: u64) {
        self.report.received += samples;
    }

    /// Raises the number of received samples to `total` and reports it at once.
    pub fn count_received_to(&mut self, total: u64) -> Result<(), TransportError> {
        if total <= self.report.received {
            return Ok(());
        }
        self.report.received = total;
        self.send()
    }

    pub fn count_sent(&mut self, samples: u64) {
        self.report.sent += samples;
    }

    /// Counts samples lost before they were received.
    pub fn count_dropped(&mut self, samples: u64) {
        self.report.dropped += samples;
    }

    /// Counts received samples that were rejected as unusable.
    pub fn count_refused(&mut self, samples: u64) {
        self.report.refused += samples;
    }

    /// Sets the node's state; published at once if it changes.
    pub fn state(&mut self, state: NodeState) -> Result<(), TransportError> {
        if self.report.state == state as u32 {
            return Ok(());
        }
        self.report.state = state as u32;
        self.send()
    }

    /// Publishes an error at once, cut to [`HealthHeader::ERROR_CAPACITY`] bytes.
    pub fn error(&mut self, error: &str) -> Result<(), TransportError> {
        self.last_error = cut(error).to_owned();
        self.send()
    }

    /// Clears the last error when the cause is gone; published with the next report.
    pub fn forget_error(&mut self) {
        self.last_error.clear();
    }

    /// Publishes a report if the last one is a second old, and the waiting log lines.
    pub fn tick(&mut self) -> Result<(), TransportError> {
        if let Some(log) = &self.log {
            log.borrow_mut().send_waiting();
        }
        if monotonic_ns() - self.report.sent_ns < PERIOD_NS {
            return Ok(());
        }
        self.send()
    }

    /// Reports that the node is about to end.
    pub fn stop(mut self) -> Result<(), TransportError> {
        self.state(NodeState::Stopped)
    }

    /// Publishes a report. If shared memory is full, it is lost; the next one has the same data.
    fn send(&mut self) -> Result<(), TransportError> {
        self.report.sent_ns = monotonic_ns();
        let losses = self.losses.count();
        let mut report = self.report;
        report.dropped += losses;
        if losses > self.losses_reported {
            self.last_error = cut(&self.losses.reason()).to_owned();
            report.state = NodeState::Degraded as u32;
        }
        let mut loan = match self.publisher.loan(self.last_error.len()) {
            Err(TransportError::SharedMemoryFull { .. }) => return Ok(()),
            other => other?,
        };
        *loan.header_mut() = report;
        loan.items_mut().copy_from_slice(self.last_error.as_bytes());
        loan.send()?;
        self.losses_reported = losses;
        Ok(())
    }
}

/// Returns the part of an error that a report has room for.
fn cut(error: &str) -> &str {
    &error[..error.floor_char_boundary(HealthHeader::ERROR_CAPACITY)]
}

impl Drop for Health {
    fn drop(&mut self) {
        if let Err(error) = self.state(NodeState::Stopped) {
            let problem = with_causes(&error);
            tracing::warn!("cannot send the last health report: {problem}");
        }
    }
}
