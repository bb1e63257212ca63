//! Combines the recent echoes of a ring of sonars into one scan.
//!
//! This module looks up the robot's poses; `regions` interprets the echoes.

pub mod regions;

use engine::heading::History;
use engine::scan::Scan;
use messages::ScanHeader;
use regions::Window;

use crate::AccumulatorError;

/// Largest age of odometry relative to its scan, nanoseconds.
const MAX_AGE_NS: i64 = 200_000_000;

/// Echoes of the last metres and the ranges derived from them.
#[derive(Debug, Clone)]
pub struct Sonar {
    window: Window,
    ranges: Vec<f32>,
}

impl Sonar {
    #[must_use]
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

    #[must_use]
    pub fn scan(&self) -> Scan<'_> {
        regions::scan_of(&self.ranges)
    }
}
