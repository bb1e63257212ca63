//! Choice of the believed place, and the evidence against it.

use std::collections::BTreeSet;

use geometry::Pose;
use messages::{TrackReason, TrackState};
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::Place;
use super::places::Places;
use super::posterior::{is_elsewhere, probability, rivals, spread};
use super::report::Report;

/// A unique pose stays unique until the probability of being elsewhere is this many times that
/// allowed for a start.
const KEPT: f64 = 2.5;

/// The tracker's belief: which of the places is the robot's, and how certain that is.
#[derive(Debug, Clone)]
pub(super) struct Belief {
    config: TrackingConfig,
    /// True if a place has been believed.
    pub(super) was_unique: bool,
    /// True if the believed place is as probable as `--sure` requires.
    is_sure: bool,
    /// True if the last needed search had no answer.
    unchecked: bool,
    /// True if a search had an answer.
    is_searched: bool,
    /// Probability of the best place, 0..=1.
    probability: f64,
    lost_by: TrackReason,
    state: TrackState,
    reason: TrackReason,
    stamp_ns: i64,
    since_ns: i64,
    since_m: f64,
}

impl Belief {
    pub(super) fn new(config: TrackingConfig) -> Self {
        Belief {
            config,
            was_unique: false,
            is_sure: false,
            unchecked: false,
            is_searched: false,
            probability: 0.0,
            lost_by: TrackReason::PoorFit,
            state: TrackState::Searching,
            reason: TrackReason::NoScan,
            stamp_ns: 0,
            since_ns: 0,
            since_m: 0.0,
        }
    }

    /// Trusts the believed place without further evidence.
    pub(super) fn trust(&mut self) {
        (self.was_unique, self.is_sure) = (true, true);
    }

    /// Advances to the next scan after a motion of the robot; returns true for the first scan.
    pub(super) fn go_on(&mut self, stamp_ns: i64, moved: Option<Pose>) -> bool {
        let is_first = self.since_ns == 0;
        if is_first {
            self.since_ns = stamp_ns;
        }
        self.stamp_ns = stamp_ns;
        self.since_m += moved.map_or(0.0, |step| step.x.hypot(step.y));
        is_first
    }

    pub(super) fn is_unique(&self) -> bool {
        self.state == TrackState::Unique
    }

    /// Notes if a search had an answer, and if it was needed.
    pub(super) fn search_ended(&mut self, was_needed: bool, has_answer: bool) {
        self.unchecked = !has_answer && (self.unchecked || was_needed);
        self.is_searched |= has_answer;
    }

    /// Handles a scan without usable beams after a path without such scans: the pose is carried by
    /// odometry alone, until the robot may be at more than one place.
    pub(super) fn see_nothing(&mut self, places: &Places, since: &DrivenPath) {
        let noise = self.config.odometry_error;
        let place = places.believed();
        if self.is_unique() && place.is_some_and(|place| place.is_blind_after(since, noise)) {
            self.is_sure = false;
            self.enter(TrackState::Doubtful);
            self.reason = TrackReason::PoorFit;
        }
    }

    fn enter(&mut self, state: TrackState) {
        if state != self.state {
            self.state = state;
            self.since_ns = self.stamp_ns;
            self.since_m = 0.0;
        }
    }

    /// Updates state and reason after the places were updated by a scan.
    pub(super) fn conclude(&mut self, places: &mut Places, is_key: bool) {
        self.probability = probability(places);
        if is_key {
            self.judge(places);
        }
        let doubt = places.doubt();
        let state = match places.believed {
            Some(_) if self.is_sure && doubt.is_none() => TrackState::Unique,
            Some(_) => TrackState::Doubtful,
            None if self.was_unique => TrackState::Lost,
            None => TrackState::Searching,
        };
        self.enter(state);
        self.reason = match (state, doubt) {
            (TrackState::Doubtful, Some(doubt)) => doubt,
            _ => self.reason(places),
        };
    }

    fn judge(&mut self, places: &mut Places) {
        let Some(best) = places.all().first().copied() else {
            places.believed = None;
            return;
        };
        if places.believed.is_some() {
            let believed = places.believed();
            let is_followed =
                believed.is_some_and(|place| !is_elsewhere(place, &best) || place.is_across(&best));
            // A leading hint is under test: the pose stays until that is decided.
            let is_tried = !is_followed && best.is_expected && believed.is_some();
            match () {
                () if !is_followed && !is_tried => self.lose(places, TrackReason::AnotherPlace),
                () if places.nowhere() > best.log_weight => {
                    self.lose(places, best.doubt.unwrap_or(TrackReason::PoorFit));
                }
                () if is_tried => self.is_sure = false,
                () => places.believed = Some(best.id),
            }
        }
        let others = 1.0 - self.probability;
        let most = 1.0 - self.config.sure;
        self.is_sure = !self.unchecked
            && best.doubt.is_none()
            && (others <= most || (self.is_sure && others <= KEPT * most));
        if self.is_sure {
            places.believed = Some(best.id);
            self.was_unique = true;
        }
    }

    fn lose(&mut self, places: &mut Places, why: TrackReason) {
        (places.believed, self.is_sure) = (None, false);
        self.lost_by = why;
    }

    fn reason(&self, places: &Places) -> TrackReason {
        let several = rivals(places.all(), self.config.sure).count() > 1;
        match self.state {
            TrackState::Unique => TrackReason::OnePlace,
            TrackState::Doubtful if self.unchecked => TrackReason::PoorFit,
            TrackState::Lost => self.lost_by,
            TrackState::Searching if places.all().is_empty() => match self.is_searched {
                true => TrackReason::NoPlace,
                false => TrackReason::NoSearch,
            },
            _ if several => TrackReason::SeveralPlaces,
            _ => TrackReason::TooEarly,
        }
    }

    /// Returns the report of the last scan. Places that are not believed have moved by `since_key`
    /// since the last key scan; the believed one has moved by `unseen` since the last usable scan,
    /// if the last scan was unusable.
    pub(super) fn report(
        &self,
        places: &Places,
        since_key: &DrivenPath,
        unseen: Option<&DrivenPath>,
    ) -> Report {
        let believed = places.believed();
        let place = believed.or(places.all().first());
        let at = place.map(|place| {
            let covariance = match believed {
                Some(_) if self.is_unique() => place.covariance,
                _ => spread(places.all(), place),
            };
            match (believed, unseen) {
                (None, _) => (place.pose.then(since_key.step), covariance),
                (Some(_), None) => (place.pose, covariance),
                (Some(_), Some(path)) => {
                    path.predict((place.pose, covariance), self.config.odometry_error)
                }
            }
        });
        let is_blind = unseen.is_some() && self.state == TrackState::Doubtful;
        // The best place is the first of them.
        let rivals: Vec<&Place> = rivals(places.all(), self.config.sure).collect();
        let maps: BTreeSet<u32> = rivals.iter().map(|place| place.map).collect();
        let others = rivals.iter().skip(1);
        let others = others.filter(|other| other.map == rivals[0].map);
        let distances = others.map(|other| rivals[0].pose.distance_to(other.pose));
        let apart = |of_two: fn(f64, f64) -> f64| distances.clone().reduce(of_two).unwrap_or(0.0);
        Report {
            state: self.state,
            reason: self.reason,
            map: place.map_or(0, |place| place.map),
            pose: at.map(|(pose, _)| pose),
            covariance: at
                .map_or_else(Matrix3::zeros, |(_, covariance)| covariance)
                .into(),
            probability: self.probability,
            score: place.filter(|_| !is_blind).map_or(0.0, |place| place.last),
            lead: (self.probability / (1.0 - self.probability).max(1e-9))
                .max(1e-9)
                .ln(),
            rivals: rivals.len() as u32,
            maps: maps.len() as u32,
            apart_m: (apart(f64::min), apart(f64::max)),
            since_ns: self.since_ns,
            since_m: self.since_m,
        }
    }
}
