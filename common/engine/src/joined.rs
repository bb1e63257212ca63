//! Joins laser scans at one time and place: several scans become one, and the motion within a scan
//! is compensated.
//!
//! Each beam is carried by odometry from the pose of its laser at the beam's time to the pose of
//! the target frame in the middle of the first laser's scan. This keeps the carried distances
//! short, and the resulting pose is the one that the scan gives without odometry. The target frame
//! is the laser if the graph has one laser, and the base if several are joined. The module is pure:
//! the caller decides when a scan arrives and when its wait for odometry is over.

mod brought;
mod config;
mod kept;
mod laser;
mod timed;

use geometry::Pose;
use messages::{FrameName, Name, Odometry, ScanHeader};

pub use brought::{Brought, LeftOut, MotionKnown};
pub use config::{JoinConfig, MotionConfig, ScanStamp};
pub use kept::Kept;
pub(crate) use timed::MAX_APART_NS;
pub use timed::TimedScan;

use crate::EngineError;
use crate::motion::Motion;
use crate::observation::{CarriedScan, Observation};
use laser::Laser;

/// Time for which a scan waits for odometry past its last beam, in milliseconds: odometry comes at
/// least ten times a second, and its sender may be delayed by the scheduler.
pub const ODOMETRY_WAIT_MS: u64 = 100;

/// Number of odometry samples kept: ten seconds at 100 Hz.
const ODOMETRY_KEPT: usize = 1024;

/// The newest scan of each laser, and the motion of the robot.
#[derive(Debug, Clone)]
pub struct Joiner {
    config: JoinConfig,
    motion: Motion,
    /// Parent and child frame of the odometry.
    odom_frame: FrameName,
    child_frame: FrameName,
    /// In the configured order; a single unnamed laser if none is configured.
    lasers: Vec<Laser>,
    /// Indices of the lasers that the last [`Joiner::bring`] joined.
    used: Vec<usize>,
    is_carried: bool,
}

/// Use of a scan that arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Scan of the first laser: it triggers an answer.
    Trigger,
    /// Scan of another joined laser: it waits for a scan of the first.
    Kept,
    /// Scan of a laser that is not joined.
    Other,
}

/// Pose of the target frame at some time, by odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByOdometry {
    /// Pose of the target frame in the odometry's frame.
    pub odom_from_target: Pose,
    /// Number of odometry starts so far, to detect restarts.
    start: u32,
    /// True if the odometry has changed since that start.
    has_moved: bool,
}

impl ByOdometry {
    /// Returns the motion of the target frame from one time to another. `None` if either pose is
    /// unknown, if odometry restarted in between, or if it has never changed until then: dead
    /// odometry does not change either, and scans show if the robot stands.
    #[must_use]
    pub fn between(before: Option<Self>, now: Option<Self>) -> Option<Pose> {
        now?.moved_since(&before?)
    }

    /// Does the same as [`ByOdometry::between`] for two known poses.
    #[must_use]
    pub fn moved_since(&self, before: &Self) -> Option<Pose> {
        let says_motion = self.start == before.start && self.has_moved;
        says_motion.then(|| {
            before
                .odom_from_target
                .inverse()
                .then(self.odom_from_target)
        })
    }
}

/// The scans that are searched together.
#[derive(Debug)]
pub enum Seen<'a> {
    /// A single scan without motion compensation.
    Still(crate::scan::Scan<'a>),
    /// Scans carried into the target frame.
    Carried(Vec<CarriedScan<'a>>),
}

impl Seen<'_> {
    /// Returns the observation to search for.
    pub fn observation(&self) -> Observation<'_> {
        match self {
            Seen::Still(scan) => Observation::Still(*scan),
            Seen::Carried(scans) => Observation::Carried(scans),
        }
    }
}

impl Joiner {
    /// Creates a joiner without scans or odometry.
    #[must_use]
    pub fn new(config: JoinConfig) -> Self {
        let lasers: Vec<Laser> = match &config.scans[..] {
            [] => vec![Laser::new(Name::new(""))],
            names => names
                .iter()
                .map(|name| Laser::new(Name::new(name)))
                .collect(),
        };
        Joiner {
            motion: Motion::keeping(ODOMETRY_KEPT),
            odom_frame: FrameName::new(""),
            child_frame: FrameName::new(""),
            used: Vec::with_capacity(lasers.len()),
            is_carried: false,
            lasers,
            config,
        }
    }

    /// Creates a joiner that keeps all odometry, for reading a recording at once.
    #[must_use]
    pub fn keeping_all(config: JoinConfig) -> Self {
        Joiner {
            motion: Motion::keeping(usize::MAX),
            ..Joiner::new(config)
        }
    }

    /// True if poses are the base's, not the laser's.
    pub fn targets_base(&self) -> bool {
        self.lasers.len() > 1
    }

    /// Converts a heading of the first laser in the map to one of the target frame, in radians.
    #[must_use]
    pub fn target_heading(&self, laser_heading: f64) -> f64 {
        match self.targets_base() {
            true => laser_heading - self.lasers[0].base_from_laser().yaw,
            false => laser_heading,
        }
    }

    /// Adds an odometry sample.
    pub fn on_odometry(&mut self, odometry: &Odometry) {
        let stamp_ns = odometry
            .stamp
            .measured_ns
            .saturating_add(self.config.motion.delay_ns());
        self.odom_frame = odometry.frame;
        self.child_frame = odometry.child_frame;
        self.motion.add(stamp_ns, odometry.odom_from_child.into());
    }

    /// Stores a scan. Its content is checked later, in [`Joiner::bring`].
    pub fn on_scan(&mut self, header: &ScanHeader, ranges: &[f32]) -> Role {
        let is_meant = |laser: &Laser| self.config.scans.is_empty() || laser.name == header.laser;
        match self.lasers.iter().position(is_meant) {
            Some(index) => {
                self.lasers[index].take(header, ranges, self.config.motion.scan_stamp);
                if index == 0 {
                    Role::Trigger
                } else {
                    Role::Kept
                }
            }
            None => Role::Other,
        }
    }

    /// True if odometry that covers the last beam is still expected.
    pub fn lacks_odometry(&self) -> bool {
        let lasers = self.lasers.iter().filter(|_| self.config.motion.deskew);
        let moving = lasers.filter(|laser| self.targets_base() || laser.takes_time());
        let last_ns = moving.filter_map(Laser::last_beam_ns).max();
        last_ns.is_some_and(|last_ns| {
            self.motion.may_reach(last_ns)
                && self
                    .motion
                    .newest_ns()
                    .is_some_and(|newest| newest < last_ns)
        })
    }

    /// True if any odometry has arrived.
    pub fn flows(&self) -> bool {
        self.motion.newest_ns().is_some()
    }

    /// Joins the newest scans at the time of the first laser's scan.
    ///
    /// # Errors
    /// If the first laser's scan is rejected or, with several lasers, its mount is unknown.
    pub fn bring(&mut self) -> Result<Brought, EngineError> {
        self.used.clear();
        self.is_carried = false;
        self.lasers[0].check()?;
        if self.targets_base() {
            return self.bring_all();
        }
        let mut brought = Brought {
            lasers: 1,
            ..Brought::default()
        };
        self.used.push(0);
        if self.config.motion.deskew && self.lasers[0].takes_time() {
            brought.motion = self.carry(0);
            self.is_carried = brought.motion != MotionKnown::Unknown;
        }
        Ok(brought)
    }

    fn bring_all(&mut self) -> Result<Brought, EngineError> {
        let first = &self.lasers[0];
        if !first.is_mounted() {
            return Err(EngineError::NoMount {
                laser: first.name.to_string(),
            });
        }
        let stamp_ns = first.stamp_ns();
        let mut brought = Brought {
            motion: self.carry(0),
            ..Brought::default()
        };
        self.used.push(0);
        for index in 1..self.lasers.len() {
            match self.fit_in(index, stamp_ns) {
                Ok(motion) => {
                    self.used.push(index);
                    brought.motion = brought.motion.max(motion);
                }
                Err(reason) => brought.left_out.push((self.lasers[index].name, reason)),
            }
        }
        self.is_carried = true;
        brought.lasers = self.used.len() as u32;
        Ok(brought)
    }

    /// Carries another laser's newest scan to the time of the first laser's.
    fn fit_in(&mut self, index: usize, stamp_ns: i64) -> Result<MotionKnown, LeftOut> {
        let laser = &self.lasers[index];
        laser.check_for(stamp_ns)?;
        match self.carry(index) {
            // Without odometry there is no sign that the robot moves.
            MotionKnown::Unknown if self.motion.is_moving() => Err(LeftOut::NoOdometry),
            motion => Ok(motion),
        }
    }

    /// Records the pose of a laser in the target frame at each of its beams; the pose at rest if
    /// odometry does not cover them.
    fn carry(&mut self, index: usize) -> MotionKnown {
        let target_ns = self.lasers[0].middle_ns();
        let child_from_base = self.child_from_base();
        let child_from_target = self.child_from_target();
        let child_from_laser = child_from_base.then(self.lasers[index].base_from_laser());
        let still = child_from_target.inverse().then(child_from_laser);
        let laser = &mut self.lasers[index];
        let Some(target) = self
            .motion
            .at(target_ns)
            .filter(|_| self.config.motion.deskew)
        else {
            laser.stand(still);
            return MotionKnown::Unknown;
        };
        let target_from_odom = target.odom_from_child.then(child_from_target).inverse();
        let mut is_between = target.is_between;
        let motion = &self.motion;
        let moved = laser.carry(|at_ns| {
            let located = motion.at(at_ns)?;
            is_between &= located.is_between;
            Some(
                target_from_odom
                    .then(located.odom_from_child)
                    .then(child_from_laser),
            )
        });
        match moved {
            None => {
                laser.stand(still);
                MotionKnown::Unknown
            }
            Some(()) if is_between => MotionKnown::ByOdometry,
            Some(()) => MotionKnown::LastTwist,
        }
    }

    /// Pose of the base in the child frame of the odometry, which is a laser's frame or the base
    /// itself.
    fn child_from_base(&self) -> Pose {
        let of_laser = self.lasers.iter().find(|l| l.has_frame(self.child_frame));
        of_laser.map_or(Pose::IDENTITY, |laser| laser.base_from_laser().inverse())
    }

    /// Returns the pose of the target frame, by odometry, at the middle of the newest scan of the
    /// first laser, see [`Motion::until`].
    pub fn by_odometry(&self) -> Option<ByOdometry> {
        self.at_time(self.lasers[0].middle_ns())
    }

    /// Returns the pose of the target frame by the newest odometry.
    pub fn by_newest_odometry(&self) -> Option<ByOdometry> {
        self.at_time(self.motion.newest_ns()?)
    }

    fn at_time(&self, stamp_ns: i64) -> Option<ByOdometry> {
        let odom_from_child = self.motion.until(stamp_ns)?;
        Some(ByOdometry {
            odom_from_target: odom_from_child.then(self.child_from_target()),
            start: self.motion.starts(),
            has_moved: self.motion.has_moved(stamp_ns),
        })
    }

    /// Parent frame of the odometry; empty before the first sample.
    pub fn odom_frame(&self) -> FrameName {
        self.odom_frame
    }

    /// Pose of the first laser on the base; `None` if its newest scan does not state it.
    pub fn base_from_laser(&self) -> Option<Pose> {
        let first = &self.lasers[0];
        first.is_mounted().then(|| first.base_from_laser())
    }

    fn child_from_target(&self) -> Pose {
        let child_from_base = self.child_from_base();
        match self.targets_base() {
            true => child_from_base,
            false => child_from_base.then(self.lasers[0].base_from_laser()),
        }
    }

    /// Returns the scans that the last [`Joiner::bring`] joined.
    pub fn seen(&self) -> Seen<'_> {
        if !self.is_carried {
            return Seen::Still(self.lasers[0].scan());
        }
        let used = self.used.iter().filter_map(|&index| self.lasers.get(index));
        Seen::Carried(used.map(Laser::carried).collect())
    }
}

#[cfg(test)]
mod tests;
