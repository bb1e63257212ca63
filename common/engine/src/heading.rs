//! Sources of a known heading of a scan.
//!
//! Odometry and ground truth are kept, and each scan picks what belongs to it, for its heading or
//! for its pose by odometry. Odometry that is too old is rejected, never extrapolated.

mod config;

use std::collections::VecDeque;

use geometry::{Pose, wrap_angle};
use messages::{GroundTruth, Odometry, ScanHeader};

pub use config::{HeadingConfig, HeadingFrom};

use crate::joined::MotionConfig;
use crate::vote_search::Prior;

/// Source of the heading of scans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeadingSource {
    /// No source: all headings are searched.
    Searched,
    /// A fixed heading in the map, in radians.
    Fixed(f64),
    /// The newest odometry that was measured before the scan.
    Odometry {
        /// Heading in the map where odometry reads 0, in radians.
        offset: f64,
        /// Maximum age of the odometry at its scan, in nanoseconds.
        max_age_ns: i64,
    },
    /// The ground truth that was measured with the scan.
    Truth,
}

/// Reason why a scan has no heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum HeadingError {
    /// No odometry was measured before the scan.
    #[error(
        "the scan needs odometry, but none is known that was measured at {scan_ns} ns or \
         before"
    )]
    NoOdometry {
        /// Time of the scan, in nanoseconds.
        scan_ns: i64,
    },
    /// The newest odometry is too old.
    #[error(
        "the newest odometry was measured {age_ns} ns before the scan: at most \
         {allowed_ns} ns are allowed"
    )]
    OldOdometry {
        /// Time from the odometry to the scan, in nanoseconds.
        age_ns: i64,
        /// Largest age allowed by the configuration, in nanoseconds.
        allowed_ns: i64,
    },
    /// No true pose was measured with the scan.
    #[error(
        "the heading is to come from the ground truth, but none is known that was \
         measured at {scan_ns} ns"
    )]
    NoTruth {
        /// Time of the scan, in nanoseconds.
        scan_ns: i64,
    },
}

/// Recent odometry and ground truth.
#[derive(Debug, Clone)]
pub struct History {
    odometry: VecDeque<Odometry>,
    truths: VecDeque<GroundTruth>,
    /// Largest number of readings of each kind.
    most: usize,
    /// Added to the stamps of odometry, in nanoseconds.
    delay_ns: i64,
}

impl History {
    /// Creates an empty history that keeps at most this many readings of each kind.
    #[must_use]
    pub fn keeping(readings: usize, motion: &MotionConfig) -> Self {
        History {
            odometry: VecDeque::new(),
            truths: VecDeque::new(),
            most: readings,
            delay_ns: motion.delay_ns(),
        }
    }

    /// Adds an odometry sample.
    pub fn on_odometry(&mut self, odometry: &Odometry) {
        let mut delayed = *odometry;
        let measured_ns = &mut delayed.stamp.measured_ns;
        *measured_ns = measured_ns.saturating_add(self.delay_ns);
        push(&mut self.odometry, self.most, delayed);
    }

    /// Adds a true pose.
    pub fn on_truth(&mut self, truth: &GroundTruth) {
        push(&mut self.truths, self.most, *truth);
    }

    /// Returns the pose of the laser by odometry at the time of `scan`. As for headings, a laser
    /// without a known mount is assumed to be at the child frame of the odometry.
    ///
    /// # Errors
    /// If no odometry was measured within `max_age_ns` nanoseconds before the scan.
    pub fn odom_from_laser(
        &self,
        scan: &ScanHeader,
        max_age_ns: i64,
    ) -> Result<Pose, HeadingError> {
        let odometry = self.odometry_of(scan, max_age_ns)?;
        Ok(Pose::from(odometry.odom_from_child).then(child_from_laser(odometry, scan)))
    }

    fn truth_of(&self, scan: &ScanHeader) -> Result<f64, HeadingError> {
        let scan_ns = scan.stamp.measured_ns;
        let mut newest_first = self.truths.iter().rev();
        newest_first
            .find(|truth| truth.stamp.measured_ns == scan_ns)
            .map(|truth| truth.map_from_laser.yaw)
            .ok_or(HeadingError::NoTruth { scan_ns })
    }

    /// Selects by time of measurement, not of arrival, because a recording played in a loop starts
    /// again.
    fn odometry_of(&self, scan: &ScanHeader, allowed_ns: i64) -> Result<&Odometry, HeadingError> {
        let scan_ns = scan.stamp.measured_ns;
        let before = self.odometry.iter();
        let newest = before
            .filter(|odometry| odometry.stamp.measured_ns <= scan_ns)
            .max_by_key(|odometry| odometry.stamp.measured_ns)
            .ok_or(HeadingError::NoOdometry { scan_ns })?;
        let age_ns = scan_ns.saturating_sub(newest.stamp.measured_ns);
        match age_ns > allowed_ns {
            true => Err(HeadingError::OldOdometry { age_ns, allowed_ns }),
            false => Ok(newest),
        }
    }
}

fn child_from_laser(odometry: &Odometry, scan: &ScanHeader) -> Pose {
    match odometry.child_frame == scan.frame || scan.mount_known != 1 {
        true => Pose::IDENTITY,
        false => scan.base_from_laser.into(),
    }
}

impl HeadingSource {
    /// Returns the kind of prior for which the map must be prepared.
    pub fn prior(&self) -> Prior {
        match self {
            HeadingSource::Searched => Prior::None,
            _ => Prior::Heading,
        }
    }

    /// Returns the laser's heading in the map at the time of `scan`, in radians; `None` if it is to
    /// be searched.
    ///
    /// Odometry of another frame than the scan's is taken for that of the base, and the mount's yaw
    /// is added if the scan states it; otherwise the offset has to include it.
    ///
    /// # Errors
    /// If no reading in `history` belongs to the scan.
    pub fn heading_of(
        &self,
        scan: &ScanHeader,
        history: &History,
    ) -> Result<Option<f64>, HeadingError> {
        match *self {
            HeadingSource::Searched => Ok(None),
            HeadingSource::Fixed(heading) => Ok(Some(heading)),
            HeadingSource::Truth => history.truth_of(scan).map(Some),
            HeadingSource::Odometry { offset, max_age_ns } => {
                let odometry = history.odometry_of(scan, max_age_ns)?;
                let mount = child_from_laser(odometry, scan).yaw;
                let yaw = odometry.odom_from_child.yaw;
                Ok(Some(wrap_angle(yaw + mount + offset)))
            }
        }
    }
}

/// Adds a reading to the last ones, oldest first, of which at most this many are kept.
fn push<R>(readings: &mut VecDeque<R>, most: usize, reading: R) {
    if readings.len() == most {
        readings.pop_front();
    }
    readings.push_back(reading);
}

#[cfg(test)]
mod tests;
