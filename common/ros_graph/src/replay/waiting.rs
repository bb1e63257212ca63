//! Waits until other nodes are ready.

use std::time::Duration;

use messages::topic;
use transport::{Flow, Graph, Health, Subscriber, TransportError, monotonic_ns};

use crate::replay::readiness::Readiness;

/// Largest time between checks of signals and health.
const TICK: Duration = Duration::from_millis(50);

/// Time between log lines about missing nodes, in nanoseconds.
const REMINDER_NS: i64 = 5_000_000_000;

pub struct Awaited {
    reports: Subscriber<topic::Health>,
    readiness: Readiness,
    reminder_ns: i64,
    are_ready: bool,
}

impl Awaited {
    pub fn new(graph: &Graph, names: &[String]) -> Result<Self, TransportError> {
        Ok(Awaited {
            reports: graph.subscriber()?,
            readiness: Readiness::of(names),
            reminder_ns: i64::MIN,
            are_ready: false,
        })
    }

    /// True once all nodes have been ready at the same time; logs which are missing.
    pub fn are_ready(&mut self) -> Result<bool, TransportError> {
        while let Some(report) = self.reports.receive()? {
            self.readiness.receive(report.header());
        }
        let missing = self.readiness.missing();
        self.are_ready |= missing.is_empty();
        if !self.are_ready && monotonic_ns() >= self.reminder_ns {
            self.reminder_ns = monotonic_ns().saturating_add(REMINDER_NS);
            tracing::info!("waiting for {}", missing.join(", "));
        }
        Ok(self.are_ready)
    }
}

pub fn wait_for_nodes(
    graph: &Graph,
    names: &[String],
    health: &mut Health,
) -> Result<(), TransportError> {
    if names.is_empty() {
        return Ok(());
    }
    let mut awaited = Awaited::new(graph, names)?;
    // The closure borrows `awaited`, so its subscriber is no input of the loop; reports are
    // received on ticks.
    graph.run(&[], TICK, |_| {
        if awaited.are_ready()? {
            return Ok(Flow::Stop);
        }
        health.tick()?;
        Ok(Flow::Continue)
    })
}
