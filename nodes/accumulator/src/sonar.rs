//! What a ring of sonars saw on its way, in place of its newest scan.
//!
//! Where the robot was is looked up here; what its echoes mean is the engine's.

use engine::heading::History;
use engine::regions::{self, Window};
use engine::scan::Scan;
use messages::ScanHeader;

use crate::AccumulatorError;

/// Odometry that was measured longer before its scan is not used, nanoseconds.
const MAX_AGE_NS: i64 = 200_000_000;

/// The echoes of the last metres, and what they are read as.
#[derive(Debug, Clone)]
pub struct Sonar {
    window: Window,
    ranges: Vec<f32>,
}

impl Sonar {
    /// Reads through this window.
    #[must_use]
    pub fn new(window: Window) -> Self {
        Sonar {
            window,
            ranges: Vec::new(),
        }
    }

    /// Takes in a scan.
    ///
    /// # Errors
    /// If no odometry covers it, or the engine refuses it; it is left
    /// out then.
    pub fn receive(
        &mut self,
        header: &ScanHeader,
        scan: &Scan<'_>,
        history: &History,
    ) -> Result<(), AccumulatorError> {
        let odom_from_laser = history.odom_from_laser(header, MAX_AGE_NS)?;
        self.window
            .add(scan, header.stamp.measured_ns, odom_from_laser)?;
        self.ranges = self.window.ranges();
        Ok(())
    }

    /// What the newest scan is read as.
    #[must_use]
    pub fn scan(&self) -> Scan<'_> {
        regions::scan_of(&self.ranges)
    }
}
