//! Where a scan's heading comes from, if it is known.
//!
//! What odometry and the ground truth said is kept, and a scan picks what
//! belongs to it, for its heading or for its pose on the way. Odometry that is too
//! old is refused, never stretched.

mod config;

use std::collections::VecDeque;

use geometry::{Pose, wrap_angle};
use messages::{FrameName, GroundTruth, Odometry, ScanHeader};

pub use config::{HeadingConfig, HeadingFrom};

use crate::localizer::Prior;

/// What is known of the heading of scans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeadingSource {
    /// Nothing: all headings are searched.
    Searched,
    /// Always the same, in the map, radians.
    Fixed(f64),
    /// The newest odometry that was measured before the scan.
    Odometry {
        /// Heading in the map where odometry says 0, radians.
        offset: f64,
        /// Between the odometry and the scan at most, nanoseconds.
        max_age_ns: i64,
    },
    /// The ground truth that was measured with the scan.
    Truth,
}

/// Why a scan has no heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum HeadingError {
    /// No odometry has it.
    #[error(
        "the scan needs odometry, but none is known that was measured at {scan_ns} ns or \
         before"
    )]
    NoOdometry {
        /// When the scan was measured, nanoseconds.
        scan_ns: i64,
    },
    /// The newest odometry is too old.
    #[error(
        "the newest odometry was measured {age_ns} ns before the scan: at most \
         {allowed_ns} ns are allowed"
    )]
    OldOdometry {
        /// Between the odometry and the scan, nanoseconds.
        age_ns: i64,
        /// By the configuration, nanoseconds.
        allowed_ns: i64,
    },
    /// No true pose has it.
    #[error(
        "the heading is to come from the ground truth, but none is known that was \
         measured at {scan_ns} ns"
    )]
    NoTruth {
        /// When the scan was measured, nanoseconds.
        scan_ns: i64,
    },
}

/// What was said about headings.
#[derive(Debug, Clone)]
pub struct History {
    odometry: Recent<Driven>,
    truths: Recent<Truth>,
}

#[derive(Debug, Clone, Copy)]
struct Driven {
    measured_ns: i64,
    odom_from_child: Pose,
    child_frame: FrameName,
}

#[derive(Debug, Clone, Copy)]
struct Truth {
    measured_ns: i64,
    yaw: f64,
}

impl History {
    /// Keeps the last readings of each kind, this many at most.
    #[must_use]
    pub fn keeping(readings: usize) -> Self {
        History {
            odometry: Recent::keeping(readings),
            truths: Recent::keeping(readings),
        }
    }

    /// Takes note of odometry.
    pub fn on_odometry(&mut self, odometry: &Odometry) {
        self.odometry.push(Driven {
            measured_ns: odometry.stamp.measured_ns,
            odom_from_child: odometry.odom_from_child.into(),
            child_frame: odometry.child_frame,
        });
    }

    /// Takes note of a true pose.
    pub fn on_truth(&mut self, truth: &GroundTruth) {
        self.truths.push(Truth {
            measured_ns: truth.stamp.measured_ns,
            yaw: truth.map_from_laser.yaw,
        });
    }

    /// The laser's pose by the odometry when it measured `scan`; as for headings, a
    /// laser whose mount is not known is taken to sit where the odometry is about.
    ///
    /// # Errors
    /// If no odometry was measured within `max_age_ns` nanoseconds before the scan.
    pub fn odom_from_laser(
        &self,
        scan: &ScanHeader,
        max_age_ns: i64,
    ) -> Result<Pose, HeadingError> {
        let odometry = odometry_of(scan, self, max_age_ns)?;
        Ok(odometry
            .odom_from_child
            .then(odometry.child_from_laser(scan)))
    }
}

impl Driven {
    fn child_from_laser(&self, scan: &ScanHeader) -> Pose {
        if self.child_frame == scan.frame || scan.mount_known != 1 {
            Pose::IDENTITY
        } else {
            scan.base_from_laser.into()
        }
    }
}

impl HeadingSource {
    /// What a localizer has to be prepared for.
    #[must_use]
    pub fn prior(&self) -> Prior {
        match self {
            HeadingSource::Searched => Prior::None,
            _ => Prior::Heading,
        }
    }

    /// The laser's heading in the map when it measured `scan`, radians; `None`
    /// where it is to be searched.
    ///
    /// Odometry of another frame than the scan's is taken for that of the
    /// robot's base, and the mount's yaw is added where the scan knows it; where
    /// it does not, the offset has to hold it.
    ///
    /// # Errors
    /// If nothing in `history` belongs to the scan.
    pub fn heading_of(
        &self,
        scan: &ScanHeader,
        history: &History,
    ) -> Result<Option<f64>, HeadingError> {
        match *self {
            HeadingSource::Searched => Ok(None),
            HeadingSource::Fixed(heading) => Ok(Some(heading)),
            HeadingSource::Truth => truth_of(scan, history).map(Some),
            HeadingSource::Odometry { offset, max_age_ns } => {
                let odometry = odometry_of(scan, history, max_age_ns)?;
                let mount = odometry.child_from_laser(scan).yaw;
                let yaw = odometry.odom_from_child.yaw;
                Ok(Some(wrap_angle(yaw + mount + offset)))
            }
        }
    }
}

fn truth_of(scan: &ScanHeader, history: &History) -> Result<f64, HeadingError> {
    let scan_ns = scan.stamp.measured_ns;
    let mut newest_first = history.truths.readings.iter().rev();
    newest_first
        .find(|truth| truth.measured_ns == scan_ns)
        .map(|truth| truth.yaw)
        .ok_or(HeadingError::NoTruth { scan_ns })
}

/// Looks by the time of measuring and not of arrival, for a recording that is
/// played over and over starts again.
fn odometry_of(
    scan: &ScanHeader,
    history: &History,
    allowed_ns: i64,
) -> Result<Driven, HeadingError> {
    let scan_ns = scan.stamp.measured_ns;
    let before = history.odometry.readings.iter();
    let newest = before
        .filter(|odometry| odometry.measured_ns <= scan_ns)
        .max_by_key(|odometry| odometry.measured_ns)
        .ok_or(HeadingError::NoOdometry { scan_ns })?;
    let age_ns = scan_ns.saturating_sub(newest.measured_ns);
    if age_ns > allowed_ns {
        return Err(HeadingError::OldOdometry { age_ns, allowed_ns });
    }
    Ok(*newest)
}

/// The last readings, oldest first.
#[derive(Debug, Clone)]
struct Recent<R> {
    readings: VecDeque<R>,
    most: usize,
}

impl<R> Recent<R> {
    fn keeping(most: usize) -> Self {
        Recent {
            readings: VecDeque::new(),
            most,
        }
    }

    fn push(&mut self, reading: R) {
        if self.readings.len() == self.most {
            self.readings.pop_front();
        }
        self.readings.push_back(reading);
    }
}

#[cfg(test)]
mod tests;
