//! Which place is believed, and what speaks against it.

use geometry::Pose;
use messages::{TrackReason, TrackState};

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::limits::FARTHEST_BEHIND;
use super::place::{MEAN_OVER, Place};

/// Scans fit badly at the place that is believed. What does so for long becomes the mean
/// there, and would be taken for good: what they are measured by is the mean before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doubt {
    mean_before: f64,
    /// Scores at key scans since.
    keys: u32,
    sum: f64,
}

impl Doubt {
    pub(super) fn new(place: &Place) -> Self {
        Doubt {
            mean_before: place.mean,
            keys: 0,
            sum: 0.0,
        }
    }

    pub(super) fn add(&mut self, place: &Place) {
        self.keys += 1;
        self.sum += place.last;
    }

    /// The mean of so many key scans that the map may have changed there.
    pub(super) fn usual(&self) -> Option<f64> {
        (self.keys >= MEAN_OVER).then(|| self.sum / f64::from(self.keys))
    }
}

/// What is believed. The verdict judges it by the places that are kept.
#[derive(Debug, Clone)]
pub(super) struct Belief {
    pub(super) config: TrackingConfig,
    /// The place that is believed.
    pub(super) place: Option<u32>,
    pub(super) was_unique: bool,
    pub(super) fits_badly: bool,
    /// Since scans fit badly there.
    pub(super) doubt: Option<Doubt>,
    /// Whether the robot is believed to have gone to another map, and the place there does not
    /// yet lead as one must that is found at the start.
    pub(super) taken_over: bool,
    /// The last search that was needed had no answer.
    pub(super) unchecked: bool,
    /// Over the next place, and over "nowhere".
    pub(super) lead: f64,
    pub(super) over_nowhere: f64,
    pub(super) bad_keys: u32,
    /// Key scans since it was not known how the robot moved.
    pub(super) connected_keys: u32,
    /// Whether odometry was interrupted, and not enough key scans have agreed since.
    pub(super) interrupted: bool,
    /// Whether the lead fell so far that it must be again what a start needs.
    pub(super) doubted: bool,
    /// Whether the laser and odometry disagree about how the robot moved to the last scan.
    pub(super) disagree: bool,
    pub(super) lost_by: TrackReason,
    pub(super) state: TrackState,
    pub(super) reason: TrackReason,
    pub(super) stamp_ns: i64,
    pub(super) since_ns: i64,
    pub(super) since_m: f64,
}

impl Belief {
    pub(super) fn new(config: TrackingConfig) -> Self {
        Belief {
            config,
            place: None,
            was_unique: false,
            fits_badly: false,
            doubt: None,
            taken_over: false,
            unchecked: false,
            lead: 0.0,
            over_nowhere: 0.0,
            bad_keys: 0,
            connected_keys: 0,
            interrupted: false,
            doubted: false,
            disagree: false,
            lost_by: TrackReason::PoorFit,
            state: TrackState::Searching,
            reason: TrackReason::NoScan,
            stamp_ns: 0,
            since_ns: 0,
            since_m: 0.0,
        }
    }

    pub(super) fn place(&self) -> Option<u32> {
        self.place
    }

    pub(super) fn believe(&mut self, id: u32) {
        self.place = Some(id);
        self.was_unique = true;
        self.doubt = None;
        (self.lead, self.over_nowhere) = (FARTHEST_BEHIND, FARTHEST_BEHIND);
    }

    /// Goes on to the next scan, to which the robot moved so; how many seconds after the one
    /// before it was measured, if there was one.
    pub(super) fn go_on(&mut self, stamp_ns: i64, moved: Option<Pose>) -> Option<f64> {
        let is_first = self.since_ns == 0;
        if is_first {
            self.since_ns = stamp_ns;
        }
        let later_ns = stamp_ns.saturating_sub(self.stamp_ns).max(0);
        self.stamp_ns = stamp_ns;
        if moved.is_none() {
            self.connected_keys = 0;
        }
        self.since_m += moved.map_or(0.0, |step| step.x.hypot(step.y));
        (!is_first).then_some(later_ns as f64 / 1e9)
    }

    /// Whether the last scan speaks against a place.
    pub(super) fn is_doubtful_at(&self, place: &Place) -> bool {
        let config = &self.config;
        let mean = self.doubt.map_or(place.mean, |doubt| doubt.mean_before);
        place.nowhere > 0.0 || place.last < config.doubt_score.max(mean - config.doubt_fall)
    }

    pub(super) fn is_doubtful(&self) -> bool {
        self.place.is_some() && self.fits_badly
    }

    /// Odometry does not say how the robot moved to this scan, as it did before.
    pub(super) fn interrupt(&mut self) {
        self.interrupted = true;
    }

    /// Whether a place is believed that nothing but how scans fit has to confirm: a search
    /// that was needed had an answer, and odometry was not interrupted.
    pub(super) fn is_checked(&self) -> bool {
        self.place.is_some() && !self.unchecked && !self.interrupted
    }

    /// Sees whether a search that was needed has an answer, or another one has.
    pub(super) fn search_ended(&mut self, was_needed: bool, has_answer: bool) {
        self.unchecked = !has_answer && (self.unchecked || was_needed);
    }

    /// Whether a place is believed, and the last scan fits there.
    pub(super) fn is_sound(&self) -> bool {
        self.place.is_some() && !self.fits_badly
    }

    /// The last scan saw nothing, and the robot has gone so since one that did: as far as to a
    /// key scan, which has nothing to go by, odometry alone carries the pose.
    pub(super) fn see_nothing(&mut self, since: &DrivenPath) {
        let is_far = since.is_far(&self.config) || since.unknown_s.is_some();
        if self.state == TrackState::Unique && (is_far || !self.is_checked()) {
            self.enter(TrackState::Doubtful);
            self.reason = TrackReason::PoorFit;
        }
    }

    pub(super) fn enter(&mut self, state: TrackState) {
        if state != self.state {
            self.state = state;
            self.since_ns = self.stamp_ns;
            self.since_m = 0.0;
        }
    }
}
