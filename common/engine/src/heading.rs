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
mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, Stamp};

    use super::*;

    const KEPT: usize = 5;
    const SECOND_NS: i64 = 1_000_000_000;

    fn stamp(measured_ns: i64) -> Stamp {
        Stamp {
            measured_ns,
            ..Stamp::default()
        }
    }

    fn turned(yaw: f64) -> Pose2 {
        Pose2 {
            x: 3.0,
            y: 4.0,
            yaw,
        }
    }

    fn scan(measured_ns: i64) -> ScanHeader {
        ScanHeader {
            stamp: stamp(measured_ns),
            frame: FrameName::new("laser"),
            ..Zeroable::zeroed()
        }
    }

    fn odometry(measured_ns: i64, yaw: f64) -> Odometry {
        Odometry {
            stamp: stamp(measured_ns),
            odom_from_child: turned(yaw),
            child_frame: FrameName::new("laser"),
            ..Zeroable::zeroed()
        }
    }

    fn truth(measured_ns: i64, yaw: f64) -> GroundTruth {
        GroundTruth {
            stamp: stamp(measured_ns),
            map_from_laser: turned(yaw),
            frame: FrameName::new("map"),
        }
    }

    const BY_ODOMETRY: HeadingSource = HeadingSource::Odometry {
        offset: 0.5,
        max_age_ns: SECOND_NS,
    };

    fn history(readings: &[(i64, f64)]) -> History {
        let mut history = History::keeping(KEPT);
        for &(measured_ns, yaw) in readings {
            history.on_odometry(&odometry(measured_ns, yaw));
        }
        history
    }

    #[track_caller]
    fn heading(source: HeadingSource, scan: &ScanHeader, history: &History) -> f64 {
        source.heading_of(scan, history).unwrap().unwrap()
    }

    #[test]
    fn a_searched_heading_is_none_and_a_fixed_one_needs_no_history() {
        let nothing = History::keeping(KEPT);
        let searched = HeadingSource::Searched.heading_of(&scan(5), &nothing);
        assert_eq!(searched.unwrap(), None);
        assert_eq!(heading(HeadingSource::Fixed(1.5), &scan(5), &nothing), 1.5);
    }

    #[test]
    fn odometry_is_the_newest_that_was_measured_before_the_scan() {
        let history = history(&[(10, 0.1), (20, 0.2), (30, 0.3)]);
        let at = |measured_ns| heading(BY_ODOMETRY, &scan(measured_ns), &history);
        assert_eq!(at(20), 0.2 + 0.5);
        assert_eq!(at(29), 0.2 + 0.5);
        assert_eq!(at(1000), 0.3 + 0.5);
    }

    #[test]
    fn a_recording_that_starts_again_finds_its_early_odometry() {
        let history = history(&[(100, 0.1), (200, 0.2), (10, 0.7)]);
        assert_eq!(heading(BY_ODOMETRY, &scan(15), &history), 0.7 + 0.5);
    }

    #[test]
    fn odometry_that_is_too_old_or_too_new_is_refused() {
        let history = history(&[(10, 0.1)]);
        let refused = |measured_ns| {
            BY_ODOMETRY
                .heading_of(&scan(measured_ns), &history)
                .unwrap_err()
        };
        assert!(matches!(
            refused(9),
            HeadingError::NoOdometry { scan_ns: 9 }
        ));
        assert_eq!(
            heading(BY_ODOMETRY, &scan(10 + SECOND_NS), &history),
            0.1 + 0.5
        );
        assert!(matches!(
            refused(11 + SECOND_NS),
            HeadingError::OldOdometry {
                age_ns: 1_000_000_001,
                allowed_ns: SECOND_NS
            }
        ));
        // Times that foreign bytes may hold do not overflow.
        refused(i64::MIN);
        let ancient = self::history(&[(i64::MIN, 0.0)]);
        assert!(BY_ODOMETRY.heading_of(&scan(i64::MAX), &ancient).is_err());
    }

    #[test]
    fn odometry_of_the_base_is_turned_by_the_mount() {
        let mut history = History::keeping(KEPT);
        let of_base = Odometry {
            child_frame: FrameName::new("base_link"),
            ..odometry(10, 0.25)
        };
        history.on_odometry(&of_base);
        let unknown = ScanHeader {
            base_from_laser: turned(1.0),
            ..scan(10)
        };
        assert_eq!(heading(BY_ODOMETRY, &unknown, &history), 0.75);
        let known = ScanHeader {
            mount_known: 1,
            ..unknown
        };
        assert_eq!(heading(BY_ODOMETRY, &known, &history), 1.75);
        history.on_odometry(&odometry(11, 0.25));
        let later = ScanHeader {
            stamp: stamp(11),
            ..known
        };
        assert_eq!(heading(BY_ODOMETRY, &later, &history), 0.75);
    }

    #[test]
    fn the_laser_sits_on_what_the_odometry_is_about() {
        let mut history = History::keeping(KEPT);
        let of_base = Odometry {
            child_frame: FrameName::new("base_link"),
            ..odometry(10, std::f64::consts::FRAC_PI_2)
        };
        history.on_odometry(&of_base);
        let mounted = ScanHeader {
            base_from_laser: Pose2 {
                x: 0.5,
                y: 0.0,
                yaw: 0.25,
            },
            mount_known: 1,
            ..scan(12)
        };
        let pose = history.odom_from_laser(&mounted, 2).unwrap();
        let expected = Pose::new(3.0, 4.5, std::f64::consts::FRAC_PI_2 + 0.25);
        assert!(pose.is_within(expected, 1e-12, 1e-12), "{pose:?}");
        assert_eq!(
            history.odom_from_laser(&mounted, 1),
            Err(HeadingError::OldOdometry {
                age_ns: 2,
                allowed_ns: 1
            })
        );
    }

    #[test]
    fn the_truth_has_exactly_the_time_of_the_scan() {
        let mut history = History::keeping(KEPT);
        history.on_truth(&truth(10, 0.1));
        history.on_truth(&truth(20, 0.2));
        assert_eq!(heading(HeadingSource::Truth, &scan(10), &history), 0.1);
        let refused = HeadingSource::Truth.heading_of(&scan(11), &history);
        assert!(matches!(
            refused,
            Err(HeadingError::NoTruth { scan_ns: 11 })
        ));
    }

    #[test]
    fn only_the_last_readings_are_kept() {
        let readings: Vec<(i64, f64)> = (0..=KEPT as i64).map(|i| (i, 0.0)).collect();
        let history = history(&readings);
        assert_eq!(history.odometry.readings.len(), KEPT);
        assert!(BY_ODOMETRY.heading_of(&scan(0), &history).is_err());
        assert!(BY_ODOMETRY.heading_of(&scan(1), &history).is_ok());
    }
}
