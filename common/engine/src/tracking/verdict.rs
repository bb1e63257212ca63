//! Which place is accepted, and with what probability.

mod apart;

use geometry::Pose;
use messages::{TrackReason, TrackState};
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::{MEAN_OVER, Place};
use super::places::{FARTHEST_BEHIND, NEAR_M, Places};
use super::report::Report;
use apart::{is_elsewhere, lead, probability, spread};

/// Key scans since a step that is not known that have to agree before a place is the only
/// one: nothing ties what was seen before to where the robot is now. One that is kept needs
/// them where odometry was interrupted.
pub(super) const MIN_KEYS: u32 = 3;

/// A lead below this makes the pose doubtful.
const MIN_LEAD: f64 = 3.0;

/// The last score may lie this much below `--least-mean` when a place becomes the only
/// one.
const LAST_BELOW: f64 = 0.1;

/// Key scans in a row that fit this much worse than what is doubtful: lost.
const LOST_SCANS: u32 = 3;
const LOST_FALL: f64 = 0.15;
const LOST_BELOW: f64 = 0.1;

/// Scans fit badly at the place that is believed. What does so for long becomes the mean
/// there, and would be taken for good: what they are measured by is the mean before.
#[derive(Debug, Clone, Copy)]
struct Doubt {
    mean_before: f64,
    /// Scores at key scans since.
    keys: u32,
    sum: f64,
}

impl Doubt {
    fn new(place: &Place) -> Self {
        Doubt {
            mean_before: place.mean,
            keys: 0,
            sum: 0.0,
        }
    }

    fn add(&mut self, place: &Place) {
        self.keys += 1;
        self.sum += place.last;
    }

    /// The mean of so many key scans that the map may have changed there.
    fn usual(&self) -> Option<f64> {
        (self.keys >= MEAN_OVER).then(|| self.sum / f64::from(self.keys))
    }
}

#[derive(Debug, Clone)]
pub(super) struct Belief {
    config: TrackingConfig,
    /// The place that is believed.
    place: Option<u32>,
    was_unique: bool,
    fits_badly: bool,
    /// Since scans fit badly there.
    doubt: Option<Doubt>,
    /// The last search that was needed had no answer.
    unchecked: bool,
    lead: f64,
    bad_keys: u32,
    /// Key scans since it was not known how the robot moved.
    connected_keys: u32,
    /// Whether odometry was interrupted, and not enough key scans have agreed since.
    interrupted: bool,
    slipped: Option<f64>,
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
            fits_badly: false,
            doubt: None,
            unchecked: false,
            lead: 0.0,
            bad_keys: 0,
            connected_keys: 0,
            interrupted: false,
            slipped: None,
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
        self.lead = FARTHEST_BEHIND;
    }

    pub(super) fn slip(&mut self, id: u32, by: f64) {
        self.believe(id);
        self.slipped = Some(by);
    }

    /// Goes on to the next scan, to which the robot moved so; how many seconds after the one
    /// before it was measured, if there was one.
    pub(super) fn go_on(&mut self, stamp_ns: i64, moved: Option<Pose>) -> Option<f64> {
        self.slipped = None;
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
        place.last < config.doubt_score.max(mean - config.doubt_fall)
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

    /// Sees how the last scan fits at the place that is believed.
    pub(super) fn look_at(&mut self, places: &Places) {
        let place = self.place.and_then(|id| places.get(id));
        self.fits_badly = place.is_some_and(|place| self.is_doubtful_at(place));
        self.doubt = match place {
            Some(place) if self.fits_badly => self.doubt.or(Some(Doubt::new(place))),
            _ => None,
        };
    }

    /// Sees what became of the places at a scan.
    pub(super) fn conclude(&mut self, places: &Places, is_key: bool) {
        if is_key {
            self.judge(places);
        }
        self.look_at(places);
        let state = match self.place {
            Some(_)
                if self.is_checked()
                    && !self.fits_badly
                    && self.lead >= MIN_LEAD
                    && !self.may_have_crossed(places.all()) =>
            {
                TrackState::Unique
            }
            Some(_) => TrackState::Doubtful,
            None if self.was_unique => TrackState::Lost,
            None => TrackState::Searching,
        };
        if state != self.state {
            self.state = state;
            self.since_ns = self.stamp_ns;
            self.since_m = 0.0;
        }
        self.reason = self.reason(places);
    }

    fn reason(&self, places: &Places) -> TrackReason {
        let several = self.rivals(places.all()).count() > 1;
        match self.state {
            TrackState::Unique if self.slipped.is_some() => TrackReason::OdometryJump,
            TrackState::Unique => TrackReason::OnePlace,
            TrackState::Doubtful if self.fits_badly || self.unchecked => TrackReason::PoorFit,
            TrackState::Doubtful if several => TrackReason::SeveralPlaces,
            TrackState::Doubtful => TrackReason::TooEarly,
            TrackState::Lost => self.lost_by,
            TrackState::Searching if places.is_empty() => TrackReason::NoPlace,
            TrackState::Searching if several => TrackReason::SeveralPlaces,
            TrackState::Searching => TrackReason::TooEarly,
        }
    }

    /// The best place, and those elsewhere that it does not lead by enough.
    fn rivals<'a>(&self, places: &'a [Place]) -> impl Iterator<Item = &'a Place> {
        let sure_lead = self.config.sure_lead;
        let best = places.first();
        places.iter().filter(move |place| {
            best.is_some_and(|best| {
                let is_best = place.id == best.id;
                let is_near = best.log_weight - place.log_weight < sure_lead;
                is_best || (is_near && is_elsewhere(place, best))
            })
        })
    }

    /// Whether the robot may be on another map, to or from which a transition leads:
    /// maps of one building are alike, so that takes as much to exclude as a start does.
    fn may_have_crossed(&self, places: &[Place]) -> bool {
        let Some(best) = places.first() else {
            return false;
        };
        self.rivals(places)
            .any(|place| place.map != best.map && (place.crossed || best.crossed))
    }

    fn judge(&mut self, places: &Places) {
        self.connected_keys += 1;
        self.interrupted &= self.connected_keys < MIN_KEYS;
        let Some(best) = places.all().first() else {
            (self.place, self.lead) = (None, 0.0);
            return;
        };
        self.lead = lead(places);
        if let Some(id) = self.place
            && id != best.id
        {
            let is_near = |place: &Place| {
                place.is_within((best.map, best.pose), NEAR_M, f64::INFINITY)
                    || (place.map != best.map && (place.crossed || best.crossed))
            };
            match places.get(id).is_some_and(is_near) {
                true => (self.place, self.doubt) = (Some(best.id), None),
                false => self.lose(TrackReason::AnotherPlace),
            }
        }
        if self.place.is_some() {
            let config = &self.config;
            let least =
                (config.doubt_score - LOST_BELOW).max(best.mean - config.doubt_fall - LOST_FALL);
            self.bad_keys = if best.last < least {
                self.bad_keys + 1
            } else {
                0
            };
            if self.bad_keys >= LOST_SCANS {
                self.lose(TrackReason::PoorFit);
            }
        }
        if let Some(doubt) = &mut self.doubt {
            doubt.add(best);
            let usual = doubt.usual();
            if usual.is_some_and(|mean| self.is_enough(mean)) {
                self.doubt = None;
            }
        }
        if self.place.is_none() && !self.unchecked && self.is_unique(best) {
            self.place = Some(best.id);
            self.was_unique = true;
            self.bad_keys = 0;
        }
    }

    /// On how many maps the best places lie.
    fn maps(&self, places: &[Place]) -> u32 {
        let mut maps: Vec<u32> = self.rivals(places).map(|place| place.map).collect();
        maps.sort_unstable();
        maps.dedup();
        maps.len() as u32
    }

    fn lose(&mut self, why: TrackReason) {
        self.place = None;
        self.lost_by = why;
    }

    fn is_unique(&self, best: &Place) -> bool {
        self.connected_keys >= MIN_KEYS
            && self.is_enough(best.mean)
            && best.last >= self.config.least_mean - LAST_BELOW
    }

    /// Whether the best place leads by enough for one with that mean score.
    fn is_enough(&self, mean: f64) -> bool {
        let config = &self.config;
        let lack = (config.sure_mean - mean).max(0.0);
        self.lead >= config.sure_lead + config.poor_fit_lead * lack && mean >= config.least_mean
    }

    /// What is to be said; places that are not believed have gone `since_key` since the
    /// last key scan.
    pub(super) fn report(&self, places: &Places, since_key: &DrivenPath) -> Report {
        let believed = self.place.and_then(|id| places.get(id));
        let place = believed.or(places.all().first());
        let pose = place.map(|place| match believed {
            Some(_) => place.pose,
            None => place.pose.then(since_key.step),
        });
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
            pose,
            covariance: match (believed, place) {
                (Some(believed), _) if self.state == TrackState::Unique => believed.covariance,
                (_, Some(place)) => spread(places.all(), place),
                (_, None) => Matrix3::zeros(),
            },
            probability: probability(self.lead),
            score: place.map_or(0.0, |place| place.last),
            lead: self.lead,
            rivals: self.rivals(places.all()).count() as u32,
            maps: self.maps(places.all()),
            apart_m: match apart_m {
                (near, far) if near <= far => (near, far),
                _ => (0.0, 0.0),
            },
            jumped: self.slipped.unwrap_or(0.0),
            since_ns: self.since_ns,
            since_m: self.since_m,
        }
    }
}
