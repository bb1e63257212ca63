//! Which place is believed, and how far.

use geometry::Pose;

use super::TrackingConfig;
use super::place::Place;
use super::places::{FARTHEST_BEHIND, NEAR_M, Places};
use super::report::{Report, State};

/// Places so near each other are not told apart by the verdict.
const DISTINCT_M: f64 = 1.0;
const DISTINCT_RADIANS: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// A lead below this makes the pose doubtful.
const LEAST_LEAD: f64 = 3.0;

/// The last score may lie so much below `--least-mean` when a place becomes the only
/// one.
const LAST_BELOW: f64 = 0.1;

/// Key scans in a row that fit this much worse than what is doubtful: lost.
const LOST_SCANS: u32 = 3;
const LOST_FALL: f64 = 0.15;
const LOST_BELOW: f64 = 0.1;

#[derive(Debug, Clone)]
pub(super) struct Belief {
    config: TrackingConfig,
    /// The place that is believed.
    place: Option<u32>,
    was_unique: bool,
    fits_badly: bool,
    lead: f64,
    bad_keys: u32,
    slipped: Option<f64>,
    state: State,
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
            lead: 0.0,
            bad_keys: 0,
            slipped: None,
            state: State::Searching,
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
        self.lead = FARTHEST_BEHIND;
    }

    pub(super) fn slip(&mut self, id: u32, by: f64) {
        self.believe(id);
        self.slipped = Some(by);
    }

    pub(super) fn go_on(&mut self, stamp_ns: i64, moved: Option<Pose>) {
        if self.since_ns == 0 {
            self.since_ns = stamp_ns;
        }
        self.stamp_ns = stamp_ns;
        self.since_m += moved.map_or(0.0, |step| step.x.hypot(step.y));
    }

    /// Whether the last scan speaks against a place.
    pub(super) fn is_doubtful_at(&self, place: &Place) -> bool {
        let config = &self.config;
        place.last < config.doubt_score.max(place.mean - config.doubt_fall)
    }

    pub(super) fn is_doubtful(&self) -> bool {
        self.place.is_some() && self.fits_badly
    }

    /// Whether a place is believed, and the last scan fits there.
    pub(super) fn is_sound(&self) -> bool {
        self.place.is_some() && !self.fits_badly
    }

    /// Sees how the last scan fits at the place that is believed.
    pub(super) fn look_at(&mut self, places: &Places) {
        let place = self.place.and_then(|id| places.get(id));
        self.fits_badly = place.is_some_and(|place| self.is_doubtful_at(place));
    }

    pub(super) fn conclude(&mut self, places: &Places, is_key: bool) {
        if is_key {
            self.judge(places);
        }
        self.look_at(places);
        let state = match self.place {
            Some(_) if !self.fits_badly && self.lead >= LEAST_LEAD => State::Unique,
            Some(_) => State::Doubtful,
            None if self.was_unique => State::Lost,
            None => State::Searching,
        };
        if state != self.state {
            self.state = state;
            self.since_ns = self.stamp_ns;
            self.since_m = 0.0;
        }
    }

    fn judge(&mut self, places: &Places) {
        let Some(best) = places.all().first() else {
            (self.place, self.lead) = (None, 0.0);
            return;
        };
        self.lead = lead(places.all());
        if let Some(id) = self.place
            && id != best.id
        {
            let is_near = |place: &Place| place.pose.is_within(best.pose, NEAR_M, f64::INFINITY);
            match places.get(id).is_some_and(is_near) {
                true => self.place = Some(best.id),
                false => self.lose(),
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
                self.lose();
            }
        }
        if self.place.is_none() && self.is_unique(best) {
            self.place = Some(best.id);
            self.was_unique = true;
            self.bad_keys = 0;
        }
    }

    fn lose(&mut self) {
        self.place = None;
    }

    fn is_unique(&self, best: &Place) -> bool {
        let config = &self.config;
        let lack = (config.sure_mean - best.mean).max(0.0);
        self.lead >= config.sure_lead + config.poor_fit_lead * lack
            && best.mean >= config.least_mean
            && best.last >= config.least_mean - LAST_BELOW
    }

    pub(super) fn report(&self, places: &Places) -> Report {
        let place = self.place.and_then(|id| places.get(id));
        let place = place.or(places.all().first());
        Report {
            state: self.state,
            pose: place.map(|place| place.pose),
            covariance: place.map_or_else(nalgebra::Matrix3::zeros, |place| place.covariance),
            score: place.map_or(0.0, |place| place.last),
            lead: self.lead,
            places: places.all().len(),
            since_ns: self.since_ns,
            since_m: self.since_m,
        }
    }
}

/// By how much the best place leads over the next that lies elsewhere. A new one is
/// not the next, unless the best is new itself.
fn lead(places: &[Place]) -> f64 {
    let Some(best) = places.first() else {
        return 0.0;
    };
    let counts = |place: &&Place| best.age <= 1 || place.age > 1;
    let is_elsewhere = |place: &&Place| {
        !place
            .pose
            .is_within(best.pose, DISTINCT_M, DISTINCT_RADIANS)
    };
    let next = places.iter().filter(counts).find(is_elsewhere);
    next.map_or(FARTHEST_BEHIND, |next| {
        (best.log_weight - next.log_weight).min(FARTHEST_BEHIND)
    })
}
