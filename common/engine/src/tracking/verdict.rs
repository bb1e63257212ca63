//! Which place is accepted, and with what probability.

mod apart;

use messages::{TrackReason, TrackState};
use nalgebra::Matrix3;

use super::belief::{Belief, Doubt};
use super::driven_path::DrivenPath;
use super::place::Place;
use super::places::Places;
use super::report::Report;
use apart::{is_elsewhere, lead, probability, spread};

/// Key scans since a step that is not known that have to agree before a place is the only
/// one: nothing ties what was seen before to where the robot is now. One that is kept needs
/// them where odometry was interrupted.
pub(super) const MIN_KEYS: u32 = 3;

/// A lead below this makes the pose doubtful, until it is again what a start needs.
const MIN_LEAD: f64 = 3.0;

/// The last score may lie this much below `--least-mean` when a place becomes the only
/// one.
const LAST_BELOW: f64 = 0.1;

/// Key scans in a row that fit this much worse than what is doubtful: lost.
const LOST_SCANS: u32 = 3;
const LOST_FALL: f64 = 0.15;
const LOST_BELOW: f64 = 0.1;

impl Belief {
    /// Sees how the last scan fits at the place that is believed.
    pub(super) fn look_at(&mut self, places: &Places) {
        let place = self.place.and_then(|id| places.get(id));
        self.fits_badly = place.is_some_and(|place| self.is_doubtful_at(place));
        self.disagree = place.is_some_and(|place| place.nowhere > 0.0 && self.fits(place));
        self.doubt = match place {
            Some(place) if self.fits_badly => self.doubt.or(Some(Doubt::new(place))),
            _ => None,
        };
    }

    /// Lead of the best place over the next hypothesis, "nowhere" included.
    fn leads_by(&self) -> f64 {
        self.lead.min(self.over_nowhere)
    }

    /// Whether a place is doubted for another reason than its score.
    fn fits(&self, place: &Place) -> bool {
        place.last >= self.config.least_mean
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
                    && !self.taken_over
                    && !self.fits_badly
                    && !self.doubted
                    && !self.may_have_crossed(places.all()) =>
            {
                TrackState::Unique
            }
            Some(_) => TrackState::Doubtful,
            None if self.was_unique => TrackState::Lost,
            None => TrackState::Searching,
        };
        self.enter(state);
        self.reason = self.reason(places);
    }

    fn reason(&self, places: &Places) -> TrackReason {
        let several = self.rivals(places.all()).count() > 1;
        match self.state {
            TrackState::Unique => TrackReason::OnePlace,
            TrackState::Doubtful if self.disagree => TrackReason::OdometryJump,
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
        self.rivals(places).any(|place| place.is_across(best))
    }

    fn judge(&mut self, places: &Places) {
        self.connected_keys += 1;
        self.interrupted &= self.connected_keys < MIN_KEYS;
        let Some(best) = places.all().first() else {
            (self.place, self.lead, self.over_nowhere) = (None, 0.0, 0.0);
            return;
        };
        self.lead = lead(places);
        self.over_nowhere = best.log_weight - places.nowhere();
        if let Some(id) = self.place
            && id != best.id
        {
            match places.get(id) {
                Some(place) if !is_elsewhere(place, best) || place.is_across(best) => {
                    (self.place, self.doubt) = (Some(best.id), None);
                    self.taken_over |= place.map != best.map;
                }
                _ => self.lose(TrackReason::AnotherPlace),
            }
        }
        if self.place.is_some() && self.over_nowhere < 0.0 {
            self.lose(match self.disagree {
                true => TrackReason::OdometryJump,
                false => TrackReason::PoorFit,
            });
        }
        self.taken_over &= !self.is_unique(best);
        self.doubted = self.leads_by() < MIN_LEAD || (self.doubted && !self.is_unique(best));
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
        (self.place, self.taken_over) = (None, false);
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
        self.lead >= config.sure_lead + config.poor_fit_lead * lack
            && self.over_nowhere >= config.sure_lead
            && mean >= config.least_mean
    }

    /// What is to be said; places that are not believed have gone `since_key` since the
    /// last key scan, and the one that is believed `unseen` since a scan that saw something,
    /// where the last one did not.
    pub(super) fn report(
        &self,
        places: &Places,
        since_key: &DrivenPath,
        unseen: Option<&DrivenPath>,
    ) -> Report {
        let believed = self.place.and_then(|id| places.get(id));
        let place = believed.or(places.all().first());
        let covariance = match (believed, place) {
            (Some(believed), _) if self.state == TrackState::Unique => believed.covariance,
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
            probability: probability(self.leads_by()),
            score: place.filter(|_| !is_blind).map_or(0.0, |place| place.last),
            lead: self.leads_by(),
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
