//! What the scan whose turn it is waits for.

use std::time::{Duration, Instant};

use messages::{ScanHeader, Stamp};

/// A scan waits this long for odometry past its last beam.
pub(super) const ODOMETRY_WAIT: Duration = Duration::from_millis(25);

/// A scan waits this long for a search: the slowest search of a map that is as large
/// as one may be takes less on a slow computer. What comes later is lost.
pub(super) const SEARCH_WAIT: Duration = Duration::from_secs(5);

/// Where the node is with a scan.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    /// There is none.
    Idle,
    /// It waits for odometry.
    Odometry { scan: ScanHeader, since: Instant },
    /// It waits for what a search finds for a scan.
    Search {
        scan: ScanHeader,
        of: Stamp,
        since: Instant,
    },
}
