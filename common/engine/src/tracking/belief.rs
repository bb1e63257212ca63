//! Which place is believed, and what speaks against it.

use geometry::Pose;
use messages::{TrackReason, TrackState};
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::Place;
use super::places::Places;
use super::posterior::{is_elsewhere, probability, rivals, spread};
use super::report::Report;

/// A pose that was unique stays so until the robot is elsewhere so many times as likely as a
/// start allows.
const KEPT: f64 = 2.5;

/// The tracker's belief: which of the places is the robot's, and how sure that is.
#[derive(Debug, Clone)]
pub(super) struct Belief {
    config: TrackingConfig,
    /// The place that is believed.
    place: Option<u32>,
    was_unique: bool,
    /// Whether the robot is at that place as likely as it has to be.
    is_sure: bool,
    /// The last search that was needed had no answer.
    unchecked: bool,
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

    /// Whether no place has been believed yet.
    pub(super) fn knows_nothing(&self) -> bool {
        self.place.is_none() && !self.was_unique
    }

    /// Takes a place for that of the robot.
    pub(super) fn believe(&mut self, id: u32) {
        self.place = Some(id);
        (self.was_unique, self.is_sure) = (true, true);
    }

    /// Follows the place that is believed, which may have become one with another.
    pub(super) fn follow(&mut self, place: Option<u32>) {
        self.place = place;
    }

    /// Goes on to the next scan, to which the robot moved so; whether it is the first.
    pub(super) fn go_on(&mut self, stamp_ns: i64, moved: Option<Pose>) -> bool {
        let is_first = self.since_ns == 0;
        if is_first {
            self.since_ns = stamp_ns;
        }
        self.stamp_ns = stamp_ns;
        self.since_m += moved.map_or(0.0, |step| step.x.hypot(step.y));
        is_first
    }

    /// The place that is believed.
    pub(super) fn of<'a>(&self, places: &'a Places) -> Option<&'a Place> {
        self.place.and_then(|id| places.get(id))
    }

    /// The reason for which the last scan speaks against the place that is believed.
    pub(super) fn doubt(&self, places: &Places) -> Option<TrackReason> {
        self.of(places).and_then(|place| place.doubt)
    }

    pub(super) fn is_unique(&self) -> bool {
        self.state == TrackState::Unique
    }

    /// Sees whether a search that was needed has an answer, or another one has.
    pub(super) fn search_ended(&mut self, was_needed: bool, has_answer: bool) {
        self.unchecked = !has_answer && (self.unchecked || was_needed);
    }

    /// The last scan saw nothing, and the robot has gone so since one that did: odometry alone
    /// carries the pose, until it may be at more than one place.
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

    /// Sees what became of the places at a scan.
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
            // A hint that leads is tried: the pose stays until that is decided.
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

    /// The best place, and those elsewhere that keep it from being unique.
    fn rivals<'a>(&self, places: &'a [Place]) -> impl Iterator<Item = &'a Place> {
        rivals(places, self.config.sure)
    }

    fn reason(&self, places: &Places) -> TrackReason {
        let several = self.rivals(places.all()).count() > 1;
        match self.state {
            TrackState::Unique => TrackReason::OnePlace,
            TrackState::Doubtful if self.unchecked => TrackReason::PoorFit,
            TrackState::Lost => self.lost_by,
            TrackState::Searching if places.is_empty() => TrackReason::NoPlace,
            _ if several => TrackReason::SeveralPlaces,
            _ => TrackReason::TooEarly,
        }
    }

    /// On how many maps the best places lie.
    fn maps(&self, places: &[Place]) -> u32 {
        let mut maps: Vec<u32> = self.rivals(places).map(|place| place.map).collect();
        maps.sort_unstable();
        maps.dedup();
        maps.len() as u32
    }

    /// The report of the last scan; places that are not believed have gone `since_key` since the
    /// last key scan, and the one that is believed `unseen` since a scan that saw something,
    /// where the last one did not.
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
            covariance: at.map_or(covariance, |(_, covariance)| covariance),
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
