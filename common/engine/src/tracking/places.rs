//! The places that are kept, and how a key scan weighs them.

mod crossing;
mod found;

use geometry::Pose;
use messages::Transition;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::belief::Belief;
use super::driven_path::DrivenPath;
use super::limits::{FARTHEST_BEHIND, MAX, MAX_NEW, MAX_OLD};
use super::nowhere::nowhere_by_score;
use super::place::Place;
use super::seen::{Fitted, Seen};
use crate::peaks::{doubt_between, lead};

/// A difference of scores, against what the best lacks of a perfect one, is worth a
/// factor of e, as for the single scan (`--lead-scale`).
const LEAD_SCALE: f64 = 0.025;

/// A candidate confirms a place whose prediction lies within four deviations.
const GATE: f64 = 16.0;

/// Fits that come so close are of one place: as candidates of a search are distinguished.
const SAME_M: f64 = 0.3;
const SAME_RADIANS: f64 = 6.5 * std::f64::consts::PI / 180.0;

/// Places that come so close are one.
const MERGED_M: f64 = 0.25;
const MERGED_RADIANS: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// A scan this far below the best, or below the least, does not fit at a place; after
/// two such key scans it is dropped.
const JUNK_BEHIND: f64 = 0.4;
const JUNK_SCORE: f64 = 0.35;
const JUNK_SCANS: u32 = 2;

/// What a key scan is measured by.
#[derive(Clone, Copy)]
struct Best<'a> {
    /// The highest score of any place, and the number of the map that it is on.
    score: f64,
    map: u32,
    /// The scan on each map.
    seen: &'a [Seen<'a>],
}

impl Best<'_> {
    /// What the true place may lack of the score, for a map that was drawn leaves it out: that
    /// of the best place, or the one of this number on which the true place is.
    fn left_out(&self, map: u32) -> f64 {
        let [best, true_one] = [self.map, map].map(|map| &self.seen[map as usize]);
        match map == self.map {
            true => best.distance_field.left_out(self.score, best.fit),
            false => {
                let drawn = [best, true_one].map(|on| on.distance_field.drawn_doubt(on.fit));
                doubt_between(self.score, drawn)
            }
        }
    }
}

/// The places where the robot may be.
#[derive(Debug, Clone)]
pub(super) struct Places {
    config: TrackingConfig,
    kept: Vec<Place>,
    /// With the numbers of their maps.
    candidates: Vec<(u32, Fitted)>,
    /// Which of them are at places that are kept.
    is_known: Vec<bool>,
    next_id: u32,
    key_scans: u32,
    /// Log weight of "nowhere"; that of the best place is subtracted at each key scan.
    nowhere: f64,
    /// What a place is behind that the first search finds: something where a place was
    /// expected beforehand, with this prediction.
    first_lag: f64,
    expected: Option<(Pose, Matrix3<f64>)>,
}

impl Places {
    pub(super) fn new(config: TrackingConfig) -> Self {
        Places {
            config,
            kept: Vec::new(),
            candidates: Vec::new(),
            is_known: Vec::new(),
            next_id: 0,
            key_scans: 0,
            nowhere: 0.0,
            first_lag: 0.0,
            expected: None,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.kept.is_empty()
    }

    /// Key scans by which places were weighed.
    pub(super) fn key_scans(&self) -> u32 {
        self.key_scans
    }

    /// Best first.
    pub(super) fn all(&self) -> &[Place] {
        &self.kept
    }

    pub(super) fn get(&self, id: u32) -> Option<&Place> {
        self.kept.iter().find(|place| place.id == id)
    }

    /// Keeps one place, on the map of a number, at which a scan was taken.
    pub(super) fn start_at(
        &mut self,
        seen: &[Seen<'_>],
        (map, predicted): (u32, (Pose, Matrix3<f64>)),
    ) -> u32 {
        let fitted = seen[map as usize].settle(predicted);
        let id = self.new_id();
        // Old enough to lead.
        let age = 2;
        self.kept = vec![Place {
            age,
            ..Place::born(id, (map, &fitted), 0.0)
        }];
        self.key_scans = age;
        self.nowhere = -FARTHEST_BEHIND;
        id
    }

    /// Keeps a place at which the robot is expected, ahead by `lead` of all that the
    /// first search finds.
    pub(super) fn expect(
        &mut self,
        seen: &[Seen<'_>],
        (map, predicted): (u32, (Pose, Matrix3<f64>)),
        lead: f64,
    ) {
        let seen = &seen[map as usize];
        let fitted = seen.settle_turned(predicted, seen.settle(predicted));
        let id = self.new_id();
        self.kept.push(Place {
            predicted,
            ..Place::born(id, (map, &fitted), 0.0)
        });
        self.first_lag = lead;
        self.nowhere = -lead;
        self.expected = Some(predicted);
    }

    /// The place with the most weight; they need not be in order.
    fn leading(&self) -> Option<&Place> {
        let places = self.kept.iter();
        places.reduce(|a, b| if b.log_weight > a.log_weight { b } else { a })
    }

    /// Log weight of "nowhere", against which the best place has its own.
    pub(super) fn nowhere(&self) -> f64 {
        self.nowhere
    }

    /// Takes "nowhere" for as likely as the best place: the robot may have moved anywhere.
    pub(super) fn forget(&mut self) {
        self.nowhere = self.kept.first().map_or(0.0, |best| best.log_weight);
    }

    fn new_id(&mut self) -> u32 {
        self.next_id += 1;
        self.next_id
    }

    /// Moves one place by a way, and fits the scan there; `since_key` is the way since the
    /// last key scan. While the robot stands, scans that agree do not move it: their errors
    /// are those of the first.
    pub(super) fn follow(
        &mut self,
        id: u32,
        seen: &[Seen<'_>],
        (path, since_key): (&DrivenPath, &DrivenPath),
    ) {
        let TrackingConfig {
            odometry_error,
            restart_fall,
            ..
        } = self.config;
        let Some(place) = self.kept.iter_mut().find(|place| place.id == id) else {
            return;
        };
        let seen = &seen[place.map as usize];
        let predicted = path.predict((place.pose, place.covariance), odometry_error);
        let mut fitted = seen.settle(predicted);
        if fitted.score < place.mean - restart_fall {
            fitted = seen.settle_turned(predicted, fitted);
        }
        place.predicted = predicted;
        let before = place.pose;
        place.set(&fitted);
        if since_key.is_rest() && fitted.off < GATE {
            place.pose = before;
        }
        place.judge(since_key, &self.config);
    }

    /// Weighs all places by a key scan, and those that were taken with them; those
    /// that are not believed have gone `path` since the last one.
    pub(super) fn weigh(
        &mut self,
        (seen, transitions): (&[Seen<'_>], &[Transition]),
        path: &DrivenPath,
        belief: &mut Belief,
    ) {
        let noise = self.config.odometry_error;
        for place in &mut self.kept {
            if belief.place() != Some(place.id) {
                place.predicted = path.predict((place.pose, place.covariance), noise);
                place.set(&seen[place.map as usize].settle(place.predicted));
            }
        }
        self.snap();
        for place in &mut self.kept {
            place.judge(path, &self.config);
        }
        let (map, score) = self.best_score();
        let best = Best { score, map, seen };
        let fits_badly = belief
            .place()
            .and_then(|id| self.get(id))
            .is_some_and(|p| belief.is_doubtful_at(p));
        self.count(best);
        self.add_new(best, belief, (fits_badly, path.unknown_s));
        self.add_across(transitions, best, belief);
        self.candidates.clear();
        self.key_scans += 1;
        self.tidy(belief);
    }

    /// The highest score of any place, and the map that it is on.
    fn best_score(&self) -> (u32, f64) {
        let places = self.kept.iter().map(|place| (place.map, place.last));
        let candidates = self.candidates.iter();
        let candidates = candidates.map(|(map, candidate)| (*map, candidate.score));
        let higher = |a: (u32, f64), b: (u32, f64)| if b.1 > a.1 { b } else { a };
        places.chain(candidates).fold((0, 0.0), higher)
    }

    /// What a key scan says against a place with a score, on the map of a number. What the maps
    /// may leave out says nothing.
    fn against(&self, best: Best<'_>, (map, score): (u32, f64)) -> f64 {
        let behind = lead(best.score, score + best.left_out(map)).max(0.0);
        (behind / LEAD_SCALE).min(self.config.scan_cap)
    }

    fn count(&mut self, best: Best<'_>) {
        // They were put in order at the key scan before, and no weight has changed since.
        let top = self.kept.first().map_or(0.0, |best| best.log_weight);
        for i in 0..self.kept.len() {
            let Place { map, last, .. } = self.kept[i];
            let against = self.against(best, (map, last));
            let place = &mut self.kept[i];
            place.log_weight += -top - against - 0.25 * place.off.min(GATE);
            let is_bad = place.last < JUNK_SCORE.max(best.score - JUNK_BEHIND);
            place.bad = if is_bad { place.bad + 1 } else { 0 };
            place.grow();
        }
        let first = self.leading().copied();
        // At the first look, the places are those that the search finds. What odometry says
        // against the best place is in its log odds already.
        let (nowhere, off) = first.map_or((nowhere_by_score(best.score), 0.0), |first| {
            (first.nowhere, first.off.min(GATE))
        });
        let cap = self.config.scan_cap;
        self.nowhere += -top + nowhere.clamp(-cap, cap) - 0.25 * off;
        if let Some(first) = first {
            self.nowhere = self.nowhere.max(first.log_weight - FARTHEST_BEHIND);
        }
    }

    /// Best first; drops what does not fit, lies too far behind, or has met another
    /// place, and what there is no room for.
    fn tidy(&mut self, belief: &mut Belief) {
        // Ids grow: of equal places the older comes first.
        self.kept.sort_unstable_by(|a, b| {
            let by_weight = b.log_weight.total_cmp(&a.log_weight);
            by_weight.then(a.id.cmp(&b.id))
        });
        let Some(top) = self.kept.first().map(|place| place.log_weight) else {
            return;
        };
        let (mut count, mut old, mut new) = (0, 0, 0);
        for i in 0..self.kept.len() {
            let place = self.kept[i];
            let is_full = match place.age > 1 {
                true => old == MAX_OLD,
                // At the first there are no others.
                false => new == if self.key_scans > 1 { MAX_NEW } else { MAX },
            };
            if place.bad >= JUNK_SCANS || is_full || place.log_weight < top - FARTHEST_BEHIND {
                continue;
            }
            let met = self.kept[..count]
                .iter_mut()
                .find(|other| other.is_within((place.map, place.pose), MERGED_M, MERGED_RADIANS));
            if let Some(other) = met {
                other.crossed_from = other.crossed_from.or(place.crossed_from);
                if belief.place() == Some(place.id) {
                    belief.believe(other.id);
                }
                continue;
            }
            self.kept[count] = place;
            count += 1;
            old += usize::from(place.age > 1);
            new += usize::from(place.age <= 1);
        }
        self.kept.truncate(count);
        self.decide_crossing();
    }
}
