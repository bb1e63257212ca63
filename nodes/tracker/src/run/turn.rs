//! State of the current scan.

use std::time::{Duration, Instant};

use messages::{ScanHeader, Stamp};

use super::TICK;

/// Longest wait for a search: even on a slow computer, the slowest one takes less.
pub(super) const SEARCH_WAIT: Duration = Duration::from_secs(5);

#[derive(Debug, Clone, Copy)]
pub(super) struct Since {
    at: Instant,
    looks: u32,
}

impl Since {
    pub(super) fn now(looks: u32) -> Self {
        let at = Instant::now();
        Since { at, looks }
    }

    /// True if the wait is over by the clock and after two checks; after a suspend, the clock alone
    /// would say so.
    pub(super) fn is_over(&self, wait: Duration, looks: u32) -> bool {
        let least = (wait.as_millis() / TICK.as_millis() / 4).max(2) as u32;
        self.at.elapsed() >= wait && looks.wrapping_sub(self.looks) >= least
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    Idle,
    Odometry {
        scan: ScanHeader,
        since: Since,
    },
    /// The scan waits for the search result of scan `of`.
    Search {
        scan: ScanHeader,
        of: Stamp,
        since: Since,
    },
}

#[cfg(test)]
mod tests {
    use engine::joined::ODOMETRY_WAIT_MS;

    use super::*;

    #[test]
    fn a_wait_needs_time_and_looks() {
        let at = |ago: Duration, looks| Since {
            at: Instant::now().checked_sub(ago).unwrap(),
            looks,
        };
        let second = Duration::from_secs(1);
        let suspended = at(100 * second, 7);
        let odometry = Duration::from_millis(ODOMETRY_WAIT_MS);
        assert!(!suspended.is_over(odometry, 8) && suspended.is_over(odometry, 9));
        assert!(!suspended.is_over(SEARCH_WAIT, 31) && suspended.is_over(SEARCH_WAIT, 32));
        assert!(!at(Duration::ZERO, 7).is_over(SEARCH_WAIT, 1000));
        assert!(at(second, u32::MAX).is_over(odometry, 1));
    }
}
