//! Combines the recent echoes of a ring of sonars, at the robot's poses, into one scan.

pub mod regions;

use engine::heading::History;
use engine::scan::Scan;
use messages::ScanHeader;
use regions::Window;

use crate::AccumulatorError;

/// Largest age of odometry relative to its scan, nanoseconds.
const MAX_AGE_NS: i64 = 200_000_000;

#[derive(Debug, Clone)]
pub struct Sonar {
    window: Window,
    ranges: Vec<f32>,
}

impl Sonar {
    pub fn new(window: Window) -> Self {
        Sonar {
            window,
            ranges: Vec::new(),
        }
    }

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

    pub fn scan(&self) -> Scan<'_> {
        regions::scan_of(&self.ranges)
    }
}
