//! Choice of the believed place, and the evidence against it.

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
    /// Id of the believed place.
    place: Option<u32>,
    was_unique: bool,
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
            place: None,
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

    pub(super) fn place(&self) -> Option<u32> {
        self.place
    }

    /// True if no place has been believed yet.
    pub(super) fn knows_nothing(&self) -> bool {
        self.place.is_none() && !self.was_unique
    }

    /// Believes a place.
    pub(super) fn believe(&mut self, id: u32) {
        self.place = Some(id);
        (self.was_unique, self.is_sure) = (true, true);
    }

    /// Replaces the believed place, which may have merged with another.
    pub(super) fn follow(&mut self, place: Option<u32>) {
        self.place = place;
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

    /// Returns the believed place.
    pub(super) fn of<'a>(&self, places: &'a Places) -> Option<&'a Place> {
        self.place.and_then(|id| places.get(id))
    }

    /// Reason why the last scan contradicts the believed place.
    pub(super) fn doubt(&self, places: &Places) -> Option<TrackReason> {
        self.of(places).and_then(|place| place.doubt)
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
        let place = self.of(places);
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
    pub(super) fn conclude(&mut self, places: &Places, is_key: bool) {
        self.probability = probability(places);
        if is_key {
            self.judge(places);
        }
        let doubt = self.doubt(places);
        let state = match self.place {
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

    fn judge(&mut self, places: &Places) {
        let Some(best) = places.all().first() else {
            self.place = None;
            return;
        };
        if let Some(id) = self.place {
            let believed = places.get(id);
            let is_followed =
                believed.is_some_and(|place| !is_elsewhere(place, best) || place.is_across(best));
            // A leading hint is under test: the pose stays until that is decided.
            let is_tried = !is_followed && best.is_expected && believed.is_some();
            match () {
                () if !is_followed && !is_tried => self.lose(TrackReason::AnotherPlace),
                () if places.nowhere() > best.log_weight => {
                    self.lose(best.doubt.unwrap_or(TrackReason::PoorFit));
                }
                () if is_tried => self.is_sure = false,
                () => self.place = Some(best.id),
            }
        }
        let others = 1.0 - self.probability;
        let most = 1.0 - self.config.sure;
        self.is_sure = !self.unchecked
            && best.doubt.is_none()
            && (others <= most || (self.is_sure && others <= KEPT * most));
        if self.is_sure && self.place != Some(best.id) {
            self.believe(best.id);
        }
    }

    fn lose(&mut self, why: TrackReason) {
        (self.place, self.is_sure) = (None, false);
        self.lost_by = why;
    }

    /// The best place, and the places elsewhere that keep it from being unique.
    fn rivals<'a>(&self, places: &'a [Place]) -> impl Iterator<Item = &'a Place> {
        rivals(places, self.config.sure)
    }

    fn reason(&self, places: &Places) -> TrackReason {
        let several = self.rivals(places.all()).count() > 1;
        match self.state {
            TrackState::Unique => TrackReason::OnePlace,
            TrackState::Doubtful if self.unchecked => TrackReason::PoorFit,
            TrackState::Lost => self.lost_by,
            TrackState::Searching if places.is_empty() => match self.is_searched {
                true => TrackReason::NoPlace,
                false => TrackReason::NoSearch,
            },
            _ if several => TrackReason::SeveralPlaces,
            _ => TrackReason::TooEarly,
        }
    }

    /// Number of maps with one of the best places.
    fn maps(&self, places: &[Place]) -> u32 {
        let mut maps: Vec<u32> = self.rivals(places).map(|place| place.map).collect();
        maps.sort_unstable();
        maps.dedup();
        maps.len() as u32
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
        let believed = self.of(places);
        let place = believed.or(places.all().first());
        let covariance = match (believed, place) {
            (Some(believed), _) if self.is_unique() => believed.covariance,
            (_, Some(place)) => spread(places.all(), place),
            (_, None) => Matrix3::zeros(),
        };
        let at = place.map(|place| match (believed, unseen) {
            (Some(_), None) => (place.pose, covariance),
            (Some(_), Some(path)) => {
                path.predict((place.pose, covariance), self.config.odometry_error)
            }
            (None, _) => (place.pose.then(since_key.step), covariance),
        });
        let is_blind = unseen.is_some() && self.state == TrackState::Doubtful;
        let best = places.all().first();
        let on_map = |other: &&Place| best.is_some_and(|best| best.map == other.map);
        let distances = self.rivals(places.all()).skip(1).filter(on_map);
        let distances = distances.filter_map(|other| Some(best?.pose.distance_to(other.pose)));
        let apart_m = distances.fold((f64::INFINITY, 0.0f64), |(near, far), distance| {
            (near.min(distance), far.max(distance))
        });
        Report {
            state: self.state,
            reason: self.reason,
            map: place.map_or(0, |place| place.map),
            pose: at.map(|(pose, _)| pose),
            covariance: at.map_or(covariance, |(_, covariance)| covariance).into(),
            probability: self.probability,
            score: place.filter(|_| !is_blind).map_or(0.0, |place| place.last),
            lead: (self.probability / (1.0 - self.probability).max(1e-9))
                .max(1e-9)
                .ln(),
            rivals: self.rivals(places.all()).count() as u32,
            maps: self.maps(places.all()),
            apart_m: match apart_m {
                (near, far) if near <= far => (near, far),
                _ => (0.0, 0.0),
            },
            since_ns: self.since_ns,
            since_m: self.since_m,
        }
    }
}
