//! Waits until the nodes that answer are there.

use std::time::Duration;

use messages::topic;
use transport::{Flow, Graph, Health, TransportError, monotonic_ns};

use crate::readiness::Readiness;

/// The longest time without a look at signals and health.
const TICK: Duration = Duration::from_millis(50);

/// Between two lines that say who is waited for, nanoseconds.
const REMINDER_NS: i64 = 5_000_000_000;

/// Waits until all these nodes are ready, or the stop flag is set.
///
/// # Errors
/// The graph fails.
pub fn wait_for_nodes(
    graph: &Graph,
    names: &[String],
    health: &mut Health,
) -> Result<(), TransportError> {
    let mut readiness = Readiness::of(names);
    if readiness.missing().is_empty() {
        return Ok(());
    }
    let reports = graph.subscriber::<topic::Health>()?;
    let mut reminder_ns = i64::MIN;
    graph.run(&[&reports], TICK, |_| {
        while let Some(report) = reports.receive()? {
            readiness.hear(report.header());
        }
        let missing = readiness.missing();
        if missing.is_empty() {
            return Ok(Flow::Stop);
        }
        if monotonic_ns() >= reminder_ns {
            reminder_ns = monotonic_ns().saturating_add(REMINDER_NS);
            tracing::info!("waiting for {}", missing.join(", "));
        }
        health.tick()?;
        Ok(Flow::Continue)
    })
}
