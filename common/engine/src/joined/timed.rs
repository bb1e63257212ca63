//! Scans and odometry as programs give them that know no messages.

use bytemuck::Zeroable;
use geometry::Pose;
use messages::{FrameName, Name, Odometry, ScanHeader, Stamp};

use super::{JoinConfig, Joiner, MotionConfig};
use crate::EngineError;
use crate::scan::Scan;

/// Largest time between the scans of two lasers that are joined, in nanoseconds.
pub(crate) const MAX_APART_NS: i64 = 1_000_000_000;

/// A scan with its time and the mount of its laser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedScan<'a> {
    /// The scan, as seen from above.
    pub scan: Scan<'a>,
    /// Time of the first range, nanoseconds.
    pub stamp_ns: i64,
    /// Time from one range to the next, seconds; 0 if all have the same time.
    pub time_increment_s: f64,
    /// Pose of the laser on the base, if it is known.
    pub base_from_laser: Option<Pose>,
}

impl TimedScan<'_> {
    /// Checks the values, see [`Scan::check`].
    ///
    /// # Errors
    /// If the scan is rejected, or the mount or the time increment is not finite.
    pub fn check(&self) -> Result<(), EngineError> {
        self.scan.check()?;
        if !self.time_increment_s.is_finite() {
            return Err(EngineError::TimeIncrement(self.time_increment_s));
        }
        match self.base_from_laser.filter(|mount| !mount.is_finite()) {
            Some(mount) => Err(EngineError::Mount(mount)),
            None => Ok(()),
        }
    }

    /// Checks scans that are to be joined, one of each laser.
    ///
    /// # Errors
    /// If a scan is rejected or, of several, one has no mount or is more than a second from the
    /// first.
    pub fn check_all(scans: &[Self]) -> Result<(), EngineError> {
        for (laser, scan) in scans.iter().enumerate() {
            scan.check()?;
            if scans.len() > 1 && scan.base_from_laser.is_none() {
                let laser = laser.to_string();
                return Err(EngineError::NoMount { laser });
            }
            let (stamp_ns, first) = (scan.stamp_ns, &scans[0]);
            let later_ns = stamp_ns.saturating_sub(first.stamp_ns);
            if later_ns.saturating_abs() > MAX_APART_NS {
                return Err(EngineError::StampsApart {
                    laser,
                    stamp_ns,
                    later_ns,
                });
            }
        }
        Ok(())
    }
}

impl JoinConfig {
    /// Returns the settings for this many lasers, which are named by their numbers from 0.
    #[must_use]
    pub fn of_lasers(lasers: usize, motion: MotionConfig) -> Self {
        let names = (0..lasers).filter(|_| lasers > 1);
        JoinConfig {
            scans: names.map(|laser| laser.to_string()).collect(),
            motion,
        }
    }
}

impl Joiner {
    /// Joins this many lasers from now on, see [`JoinConfig::of_lasers`]. Scans are dropped, and
    /// odometry is kept.
    pub fn join_lasers(&mut self, lasers: usize) {
        let config = JoinConfig::of_lasers(lasers, self.config.motion.clone());
        let motion = self.motion.clone();
        *self = Joiner {
            motion,
            odom_frame: self.odom_frame,
            child_frame: self.child_frame,
            ..Joiner::new(config)
        };
    }

    /// Adds the pose of the base by odometry.
    pub fn add_odometry(&mut self, stamp_ns: i64, odom_from_base: Pose) {
        self.on_odometry(&Odometry {
            stamp: Stamp::measured_at(stamp_ns),
            odom_from_child: odom_from_base.into(),
            child_frame: FrameName::new("base"),
            ..Odometry::zeroed()
        });
    }

    /// Stores a scan of the laser with this number, see [`JoinConfig::of_lasers`].
    pub fn add_scan(&mut self, laser: usize, timed: &TimedScan<'_>) {
        let TimedScan { scan, .. } = *timed;
        let header = ScanHeader {
            stamp: Stamp::measured_at(timed.stamp_ns),
            angle_min: scan.angle_min,
            angle_increment: scan.angle_increment,
            time_increment_s: timed.time_increment_s,
            range_min_m: scan.range_min_m,
            range_max_m: scan.range_max_m,
            base_from_laser: timed.base_from_laser.unwrap_or_default().into(),
            mount_known: timed.base_from_laser.is_some().into(),
            laser: Name::new(&laser.to_string()),
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        self.on_scan(&header, scan.ranges);
    }
}
