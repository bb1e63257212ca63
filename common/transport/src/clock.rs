//! The clock of latencies. Of no use for dates: it counts from the host's start.

use nix::time::{ClockId, clock_gettime};

/// `CLOCK_MONOTONIC` in nanoseconds: the same clock in every process of a host,
/// started at boot, never set back.
#[must_use]
pub fn monotonic_ns() -> i64 {
    // The clock exists on every Linux, and 292 years of nanoseconds fit.
    let now = clock_gettime(ClockId::CLOCK_MONOTONIC).expect("Linux has a monotonic clock");
    now.tv_sec() * 1_000_000_000 + now.tv_nsec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn never_runs_backwards() {
        let first = monotonic_ns();
        assert!(first > 0);
        assert!(monotonic_ns() >= first);
    }
}
