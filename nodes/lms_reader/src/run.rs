//! Reads from a device or a capture and publishes the scans.

mod capture;
mod outlet;
mod serial;
mod tcp;

use std::fmt::Display;
use std::time::{Duration, Instant};

use transport::Graph;

use crate::scan::Received;
use crate::{Config, LmsError};
use outlet::Outlet;

/// Publishes scans until the capture ends or the stop flag is set.
///
/// A device that cannot be reached is tried again; a telegram that gives no scan is counted as
/// refused.
pub fn run(graph: &Graph, config: &Config) -> Result<(), LmsError> {
    let mut outlet = Outlet::open(graph, config)?;
    match (&config.tcp, &config.serial, &config.capture) {
        (Some(address), _, _) => tcp::run(&graph.name().resolve(address), config, &mut outlet),
        (None, Some(device), _) => serial::run(device, config, &mut outlet),
        (None, None, Some(path)) => capture::run(path, config, &mut outlet),
        (None, None, None) => Err(LmsError::Other(
            "neither a device (--tcp, --serial) nor a capture (--capture) is given".into(),
        )),
    }
}

/// Runs `listen` until it succeeds or the stop flag is set. Waits between attempts, and longer
/// after each attempt without a scan.
fn keep(
    outlet: &mut Outlet,
    mut listen: impl FnMut(&mut Outlet) -> Result<(), LmsError>,
) -> Result<(), LmsError> {
    let mut failures = 0;
    while !outlet.stopped() {
        let before = outlet.sent;
        match listen(outlet) {
            Ok(()) => break,
            Err(error @ LmsError::Transport(_)) => return Err(error),
            Err(_) if outlet.stopped() => break,
            Err(error) => outlet.lost(&error)?,
        }
        if outlet.sent > before {
            failures = 0;
        }
        outlet.wait_until(Instant::now() + wait_after(failures))?;
        failures += 1;
    }
    Ok(())
}

/// Returns the wait after a failure that follows so many others: 0.25 s, doubled up to 5 s.
fn wait_after(failures: u32) -> Duration {
    let wait = Duration::from_millis(250 << failures.min(16));
    wait.min(Duration::from_secs(5))
}

fn now() -> Received {
    Received {
        realtime_ns: transport::wall_ns(),
        monotonic_ns: transport::monotonic_ns(),
    }
}

fn failed(address: impl Display, what: &'static str, error: impl Into<std::io::Error>) -> LmsError {
    LmsError::Io {
        address: address.to_string(),
        what,
        source: error.into(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn waits_double_up_to_their_limit() {
        let waits = [0, 1, 2, 3, 4, 5, 1000].map(|n| super::wait_after(n).as_millis());
        assert_eq!(waits, [250, 500, 1000, 2000, 4000, 5000, 5000]);
    }
}
