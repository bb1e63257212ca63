//! A node's report on itself.
//!
//! It reports what the node sets; what makes a node ready or degraded, the node knows.

use std::cell::RefCell;
use std::rc::Rc;

use messages::topic;
use messages::{HealthHeader, Name, NodeState};

use crate::log_sender::LogSender;
use crate::losses::Losses;
use crate::{Publisher, TransportError, monotonic_ns, with_causes};

/// Between two reports, nanoseconds.
const PERIOD_NS: i64 = 1_000_000_000;

/// Counts what a node does and publishes it on topic `health`.
#[derive(Debug)]
pub struct Health {
    publisher: Publisher<topic::Health>,
    report: HealthHeader,
    last_error: String,
    /// Samples that found no room.
    losses: Losses,
    /// How many of them the last report counted.
    losses_reported: u64,
    /// The node's, for nodes that have a loop of their own.
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

    /// Counts samples taken from inputs.
    pub fn count_received(&mut self, samples: u64) {
        self.report.received += samples;
    }

    /// Counts samples taken until there are `total`, and reports that now, for whoever waits for it.
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
    pub fn count_received_to(&mut self, total: u64) -> Result<(), TransportError> {
        if total <= self.report.received {
            return Ok(());
        }
        self.report.received = total;
        self.send()
    }

    /// Counts samples sent.
    pub fn count_sent(&mut self, samples: u64) {
        self.report.sent += samples;
    }

    /// Counts samples lost before they could be taken.
    pub fn count_dropped(&mut self, samples: u64) {
        self.report.dropped += samples;
    }

    /// Counts samples taken and refused as unusable.
    pub fn count_refused(&mut self, samples: u64) {
        self.report.refused += samples;
    }

    /// Says what the node is doing; sent at once if that is new.
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
    pub fn state(&mut self, state: NodeState) -> Result<(), TransportError> {
        if self.report.state == state as u32 {
            return Ok(());
        }
        self.report.state = state as u32;
        self.send()
    }

    /// Keeps `error` as the last one and sends it at once, cut to
    /// [`HealthHeader::ERROR_CAPACITY`] bytes between characters.
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
    pub fn error(&mut self, error: &str) -> Result<(), TransportError> {
        let end = error.floor_char_boundary(HealthHeader::ERROR_CAPACITY);
        self.last_error.clear();
        self.last_error.push_str(&error[..end]);
        self.send()
    }

    /// Forgets the last error, where it turned out to be none; reported with the next
    /// report.
    pub fn forget_error(&mut self) {
        self.last_error.clear();
    }

    /// Sends a report if the last one is a second old, and what was logged.
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
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
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
    pub fn stop(mut self) -> Result<(), TransportError> {
        self.state(NodeState::Stopped)
    }

    /// A report that finds no room is lost: the next one holds what it held.
    fn send(&mut self) -> Result<(), TransportError> {
        self.report.sent_ns = monotonic_ns();
        let losses = self.losses.count();
        let mut report = self.report;
        report.dropped += losses;
        if losses > self.losses_reported {
            self.last_error = self.losses.reason();
            let end = self
                .last_error
                .floor_char_boundary(HealthHeader::ERROR_CAPACITY);
            self.last_error.truncate(end);
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

impl Drop for Health {
    fn drop(&mut self) {
        if let Err(error) = self.state(NodeState::Stopped) {
            let problem = with_causes(&error);
            tracing::warn!("cannot send the last health report: {problem}");
        }
    }
}
