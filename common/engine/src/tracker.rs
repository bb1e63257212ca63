//! Tracking of a robot by scans and odometry, in one call for each scan.
//!
//! ```text
//! odometry ─ Joiner: motion ─┐
//! scans ─── Joiner: joined ──┴─► PlaceTracker ─► TrackedPose
//!                                  ▲       │ if it needs a search
//!                                  └─ Localizer
//! ```
//!
//! In the graph, the tracker and the searches run in processes of their own; a [`Tracker`] runs them
//! one after the other, with the same code.

use std::sync::Arc;

use geometry::{Covariance, Pose};
use messages::Name;

use crate::EngineError;
use crate::fit::Ends;
use crate::joined::{ByOdometry, JoinConfig, Joiner, Kept, LeftOut, MotionConfig, TimedScan};
use crate::localizer::{Localizer, Workspace};
use crate::observation::Observation;
use crate::peaks::Target;
use crate::tracking::{Candidate, Need, PlaceTracker, Report, Seen, TrackingConfig};

/// Smallest time between two scans of a laser, in nanoseconds: stamps in another unit rise by less.
pub(crate) const MIN_PERIOD_NS: i64 = 1_000_000;

/// Settings of a [`Tracker`].
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TrackerSettings {
    /// Weighing of the places.
    pub tracking: TrackingConfig,
    /// Measurement of the motion.
    pub motion: MotionConfig,
}

/// Finds a robot, and tracks its pose from scan to scan, because a single scan may be ambiguous or
/// misleading. It decides by the stamps and the order of calls alone, so that the same calls give
/// the same poses.
#[derive(Debug)]
pub struct Tracker {
    localizer: Arc<Localizer>,
    settings: TrackerSettings,
    workspace: Workspace,
    state: State,
}

/// State that is kept from scan to scan.
#[derive(Debug)]
struct State {
    places: PlaceTracker,
    /// Newest scans, and the motion of the robot.
    joiner: Joiner,
    /// Stamp of the newest scan of each laser; empty before the first update.
    stamps_ns: Vec<i64>,
    /// Scans whose search will be used later.
    asked: Option<Kept>,
    /// Odometry of the target frame at the previous scan.
    before: Option<ByOdometry>,
    /// Map and pose at which the robot is expected, with the covariance.
    expected: Option<((u32, Pose), Covariance)>,
}

/// Pose of the robot, its certainty, and the reason.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TrackedPose {
    /// Time of the scan of the first laser, nanoseconds.
    pub stamp_ns: i64,
    /// State of the tracker and its reason. The pose is that of the laser or, of several, of the
    /// base.
    pub report: Report,
    /// True if the maps were searched for this scan, which takes longer.
    pub is_searched: bool,
    /// Numbers of the lasers whose scans were left out, with the reasons.
    pub left_out: Vec<(usize, LeftOut)>,
    /// True if the mount of the first laser is known, and with it the pose of the base.
    pub is_mount_known: bool,
    target: Target,
    odom_from_target: Option<Pose>,
}

impl TrackedPose {
    /// Pose of the first laser in the map, with its covariance: the believed place, otherwise the
    /// leading one. `None` if there is no place.
    pub fn laser(&self) -> Option<(Pose, Covariance)> {
        self.carried(|target| self.target.laser(target))
    }

    /// The same of the base; `None` if the mount of the laser is unknown, too.
    pub fn base(&self) -> Option<(Pose, Covariance)> {
        let base = self.carried(|target| self.target.base(target));
        base.filter(|_| self.is_mount_known)
    }

    /// Pose of the odometry's origin in the map; `None` without a place or without odometry.
    pub fn map_from_odom(&self) -> Option<Pose> {
        let (target, odom_from_target) = self.report.pose.zip(self.odom_from_target)?;
        Some(target.then(odom_from_target.inverse()))
    }

    fn carried(&self, to: impl Fn(Pose) -> Pose) -> Option<(Pose, Covariance)> {
        let target = self.report.pose?;
        let pose = to(target);
        Some((pose, self.report.covariance.carried(target, pose)))
    }
}

impl State {
    fn new(settings: &TrackerSettings) -> Self {
        State {
            places: PlaceTracker::new(settings.tracking),
            joiner: Joiner::new(JoinConfig::of_lasers(1, settings.motion.clone())),
            stamps_ns: Vec::new(),
            asked: None,
            before: None,
            expected: None,
        }
    }

    /// Joins scans, and returns the lasers that are left out.
    fn take(&mut self, scans: &[TimedScan<'_>]) -> Result<Vec<(usize, LeftOut)>, EngineError> {
        if self.stamps_ns.is_empty() {
            self.joiner.join_lasers(scans.len());
        }
        for (laser, scan) in scans.iter().enumerate() {
            if self.stamps_ns.get(laser) != Some(&scan.stamp_ns) {
                self.joiner.add_scan(laser, scan);
            }
        }
        self.stamps_ns.clear();
        self.stamps_ns
            .extend(scans.iter().map(|scan| scan.stamp_ns));
        let left_out = self.joiner.bring()?.left_out.into_iter();
        let number = |laser: Name| laser.as_str().parse().ok();
        Ok(left_out
            .filter_map(|(laser, why)| Some((number(laser)?, why)))
            .collect())
    }
}

impl Tracker {
    /// Creates a tracker of a robot that may be anywhere on the maps of a localizer, which several
    /// trackers may share. It changes to another map when a search finds it there.
    #[must_use]
    pub fn new(localizer: impl Into<Arc<Localizer>>, settings: TrackerSettings) -> Self {
        Tracker {
            localizer: localizer.into(),
            state: State::new(&settings),
            settings,
            workspace: Workspace::default(),
        }
    }

    /// Adds odometry: the pose of the base since the odometry's start, at a time in nanoseconds.
    ///
    /// It must come in the order of time, or it is ignored, and before the scans that it covers: up
    /// to the middle of a scan, or to its end if the motion within the scan is to be compensated.
    /// Odometry that goes back by more than a second counts as a restart.
    ///
    /// # Errors
    /// If the pose is not finite.
    pub fn add_odometry(&mut self, stamp_ns: i64, odom_from_base: Pose) -> Result<(), EngineError> {
        if !odom_from_base.is_finite() {
            return Err(EngineError::Odometry(odom_from_base));
        }
        self.state.joiner.add_odometry(stamp_ns, odom_from_base);
        Ok(())
    }

    /// Tracks the robot to a scan or, if it has several lasers, to one scan of each.
    ///
    /// The first laser is the main one: its scan gives the time, and must be at least a millisecond
    /// after the last. The scans of the others are carried to that time by odometry. Each update has
    /// as many scans as the first, in the same order; a laser without a new scan repeats the last.
    /// Without any odometry, scans are matched to each other.
    ///
    /// # Errors
    /// If the scans are rejected, see [`Tracker::check`], or the localizer was prepared for known
    /// headings.
    pub fn update(&mut self, scans: &[TimedScan<'_>]) -> Result<TrackedPose, EngineError> {
        let tracked = self.update_unless(scans, &|| false)?;
        Ok(tracked.expect("a search that nothing stops ends with an answer"))
    }

    /// Does the same as [`Tracker::update`], but returns `None` if a search was needed and `stop`
    /// returned true before its end. The scan then counts as one whose search has no answer.
    ///
    /// # Errors
    /// See [`Tracker::update`].
    pub fn update_unless(
        &mut self,
        scans: &[TimedScan<'_>],
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<TrackedPose>, EngineError> {
        self.check(scans)?;
        let left_out = self.state.take(scans)?;
        let (maps, state) = (self.localizer.maps(), &mut self.state);
        let joined = state.joiner.seen();
        let ends = maps.iter().map(|map| map.ends(joined.observation()));
        let ends = ends.collect::<Result<Vec<Ends>, EngineError>>()?;
        let seen = maps.iter().zip(&ends).map(|(map, ends)| map.seen(ends));
        let seen: Vec<Seen<'_>> = seen.collect();
        let mount = state.joiner.base_from_laser();
        let target = Target::of(mount, state.joiner.targets_base());
        if let Some(((map, base), covariance)) = state.expected.take() {
            let pose = target.from_base(base);
            let covariance = covariance.carried(base, pose);
            state.places.expect((map, pose), covariance);
        }
        let now = state.joiner.by_odometry();
        let moved = ByOdometry::between(state.before, now);
        state.before = now;
        let stamp_ns = scans[0].stamp_ns;
        let need = state.places.begin(&seen, stamp_ns, moved);
        let asked = state.asked.take_if(|_| need != Need::Nothing);
        let mut search = |scan: Observation<'_>| -> Result<_, EngineError> {
            let found = self
                .localizer
                .locate_unless(&mut self.workspace, scan, None, stop)?;
            Ok(found.map(|answer| Candidate::of_places(answer.places, target, target)))
        };
        let found = match need {
            Need::Nothing => None,
            Need::ThisScan => Some(search(joined.observation())),
            Need::EarlierScan => asked.map(|kept| search(kept.seen().observation())),
        };
        let (is_searched, found) = (found.is_some(), found.transpose());
        let known = found
            .as_ref()
            .ok()
            .and_then(|found| found.as_ref()?.as_deref());
        // A scan that was begun is finished, even if its search was not.
        state.places.finish(&seen, known);
        if state.places.asks_ahead() {
            state.asked = Some(Kept::of(&joined));
        }
        if let Some(None) = found? {
            return Ok(None);
        }
        Ok(Some(TrackedPose {
            stamp_ns,
            report: state.places.report(),
            is_searched,
            left_out,
            target,
            is_mount_known: mount.is_some(),
            odom_from_target: now.map(|now| now.odom_from_target),
        }))
    }

    /// Checks the scans of an update, and changes nothing.
    ///
    /// # Errors
    /// If a scan is rejected, if its stamp does not rise or is more than a second from that of the
    /// first laser, if there are not as many scans as in the first update, or if one of several
    /// lasers has no mount.
    pub fn check(&self, scans: &[TimedScan<'_>]) -> Result<(), EngineError> {
        let before = &self.state.stamps_ns;
        if scans.is_empty() || (scans.len() != before.len() && !before.is_empty()) {
            let (given, lasers) = (scans.len(), before.len().max(1));
            return Err(EngineError::Lasers { given, lasers });
        }
        TimedScan::check_all(scans)?;
        for (laser, (scan, before)) in scans.iter().zip(before).enumerate() {
            let (stamp_ns, later_ns) = (scan.stamp_ns, scan.stamp_ns.saturating_sub(*before));
            let is_repeated = laser > 0 && later_ns == 0;
            if later_ns < MIN_PERIOD_NS && !is_repeated {
                return Err(EngineError::StampOrder {
                    laser,
                    stamp_ns,
                    later_ns,
                });
            }
        }
        Ok(())
    }

    /// Expects the robot, at the next scan, at a pose on the map with this number: the pose of the
    /// base or, if the mount is unknown, of the laser. It is tried first, and believed as soon as a
    /// scan fits there and no other place within the covariance fits as well. A believed pose is
    /// kept until then; if there is none, everything else is forgotten.
    ///
    /// # Errors
    /// If the pose is not on the map, or the covariance is not positive definite.
    pub fn expect(
        &mut self,
        (map, pose): (u32, Pose),
        covariance: Covariance,
    ) -> Result<(), EngineError> {
        let on = self.localizer.maps().get(map as usize);
        if !on.is_some_and(|on| on.distance_field().holds(pose)) {
            return Err(EngineError::ExpectedPose { map, pose });
        }
        if !covariance.is_positive_definite() {
            return Err(EngineError::Covariance(covariance.to_rows()));
        }
        self.state.expected = Some(((map, pose), covariance));
        Ok(())
    }

    /// Forgets everything, so that the next scan is the first.
    pub fn reset(&mut self) {
        self.state = State::new(&self.settings);
    }
}

#[cfg(test)]
mod tests;
