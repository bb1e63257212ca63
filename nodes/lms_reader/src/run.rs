//! Reads from a device or a capture and publishes the scans.

mod capture;
mod outlet;
mod serial;
mod tcp;

use std::time::Instant;

use transport::Graph;

use crate::backoff::Backoff;
use crate::scan::Received;
use crate::{Config, LmsError};
use outlet::Outlet;

/// Publishes scans until the capture ends or the stop flag is set.
///
/// A device that cannot be reached is tried again; a telegram that gives no scan is counted as
/// refused.
///
/// # Errors
/// If the transport fails, the capture cannot be read or has no usable scan, or the configuration
/// names no source.
pub fn run(graph: &Graph, config: &Config) -> Result<(), LmsError> {
    let mut outlet = Outlet::open(graph, config)?;
    match (&config.tcp, &config.serial, &config.capture) {
        (Some(address), _, _) => tcp::run(&graph.name().resolve(address), config, &mut outlet),
        (None, Some(device), _) => serial::run(device, config, &mut outlet),
        (None, None, Some(path)) => capture::run(path, config, &mut outlet),
        (None, None, None) => Err(LmsError::NoSource),
    }
}

/// Runs `listen` until it succeeds or the stop flag is set. Waits between attempts, and longer
/// after each attempt without a scan.
fn keep(
    outlet: &mut Outlet,
    mut listen: impl FnMut(&mut Outlet) -> Result<(), LmsError>,
) -> Result<(), LmsError> {
    let mut backoff = Backoff::default();
    while !outlet.stopped() {
        let before = outlet.sent;
        match listen(outlet) {
            Ok(()) => break,
            Err(error @ LmsError::Transport(_)) => return Err(error),
            Err(error) => outlet.lost(&error)?,
        }
        if outlet.sent > before {
            backoff.reset();
        }
        outlet.wait_until(Instant::now() + backoff.next_wait())?;
    }
    Ok(())
}

fn now() -> Received {
    Received {
        realtime_ns: transport::wall_ns(),
        monotonic_ns: transport::monotonic_ns(),
    }
}
