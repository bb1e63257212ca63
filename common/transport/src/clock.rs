//! The monotonic clock for latencies, and the wall clock for dates.

use std::time::{SystemTime, UNIX_EPOCH};

use messages::Stamp;
use nix::time::{ClockId, clock_gettime};

/// Returns `CLOCK_MONOTONIC` in nanoseconds, the same in every process of a host.
pub fn monotonic_ns() -> i64 {
    // The clock exists on every Linux, and 292 years of nanoseconds fit.
    let now = clock_gettime(ClockId::CLOCK_MONOTONIC).expect("Linux has a monotonic clock");
    now.tv_sec() * 1_000_000_000 + now.tv_nsec()
}

/// Returns the stamp of a measurement that enters the graph now.
pub fn stamp_now(measured_ns: i64, counter: u64) -> Stamp {
    Stamp {
        measured_ns,
        entered_ns: monotonic_ns(),
        counter,
    }
}

/// Returns the wall clock in nanoseconds since 1970; 0 if it is set before that.
pub fn wall_ns() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| {
        i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
    })
}
