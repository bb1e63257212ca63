//! What the scan whose turn it is waits for.

use std::time::{Duration, Instant};

use messages::{ScanHeader, Stamp};

use super::TICK;

/// A scan waits this long for a search: the slowest search of a map that is as large
/// as one may be takes less on a slow computer. What comes later is lost.
pub(super) const SEARCH_WAIT: Duration = Duration::from_secs(5);

/// Since when something is waited for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Since {
    at: Instant,
    /// How often the node had looked then.
    looks: u32,
}

impl Since {
    pub(super) fn now(looks: u32) -> Self {
        let at = Instant::now();
        Since { at, looks }
    }

    /// Whether that is long ago by the clock and by how often the node has looked since, a
    /// few times at least: after a computer was suspended, the clock alone says that it is,
    /// and nobody had time to send anything.
    pub(super) fn is_over(&self, wait: Duration, looks: u32) -> bool {
        let least = (wait.as_millis() / TICK.as_millis() / 4).max(2) as u32;
        self.at.elapsed() >= wait && looks.wrapping_sub(self.looks) >= least
    }
}

/// Where the node is with a scan.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    /// There is none.
    Idle,
    /// It waits for odometry.
    Odometry { scan: ScanHeader, since: Since },
    /// It waits for what a search finds for a scan.
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
