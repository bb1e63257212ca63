//! The places that are kept, and their weighing at a key scan.

mod crossing;
mod found;
mod hint;

use geometry::Pose;
use messages::{TrackReason, Transition};
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::nowhere::{explained, nowhere_by_score};
use super::place::{MAX, MAX_NEW, MAX_OLD, Place};
use super::seen::{Fitted, Seen};
use crate::peaks::{doubt_between, lead};
pub(super) use hint::Hint;
use hint::WeighedHint;

/// Score difference worth a factor of e, relative to the gap from the best score to a perfect one.
/// It is six times that of a single scan (`--lead-scale`), because a map has the same errors in
/// each scan.
const LEAD_SCALE: f64 = 0.15;

/// Log odds against an event that can always happen between two key scans: the robot is carried
/// away, or a sensor fails.
const SELDOM: f64 = 7.0;

/// Log odds against an operator who is wrong, or a robot that was moved while switched off.
const EXPECTED: f64 = 3.5;

/// Log odds behind the best at which a place is dropped.
const FARTHEST_BEHIND: f64 = 12.0;

/// Loss of log weight per squared deviation from odometry.
const BY_DEVIATION: f64 = 0.1;

/// Squared deviation within which a candidate confirms a prediction (four standard deviations).
const GATE: f64 = 16.0;

/// Distances within which two fits belong to one place, in metres and radians; the same as for the
/// candidates of a search.
const SAME_M: f64 = 0.3;
const SAME_RADIANS: f64 = 6.5 * std::f64::consts::PI / 180.0;

/// Distances within which two places are merged, in metres and radians.
const MERGED_M: f64 = 0.25;
const MERGED_RADIANS: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// Reference values of a key scan.
#[derive(Clone, Copy)]
struct Best<'a> {
    /// Highest score of any place, and the number of its map.
    score: f64,
    map: u32,
    /// The scan on each map.
    seen: &'a [Seen<'a>],
}

impl Best<'_> {
    /// Evidence of a key scan, at most `cap`, against a place with this score on this map. Score
    /// that the maps may leave out does not count.
    fn against(&self, at: (u32, f64), cap: f64) -> f64 {
        self.behind(at).min(explained(self.score).min(cap))
    }

    /// Does the same without the cap of a key scan.
    fn behind(&self, (map, score): (u32, f64)) -> f64 {
        lead(self.score, score + self.left_out(map)).max(0.0) / LEAD_SCALE
    }

    /// Score that the true place, on the map with this number, may lack because a drawn map leaves
    /// things out. It follows from the map of the best place, and from this one if it differs.
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
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    config: TrackingConfig,
    kept: Vec<Place>,
    /// Id of the believed place.
    pub(super) believed: Option<u32>,
    /// Each with the number of its map.
    candidates: Vec<(u32, Fitted)>,
    last_id: u32,
    key_scans: u32,
    /// Log weight of "nowhere"; that of the best place is subtracted at each key scan.
    nowhere: f64,
    /// True if a search has found a place since the last unknown step.
    was_searched: bool,
    /// Hint for the next key scan.
    expected: Option<WeighedHint>,
}

impl Places {
    pub(super) fn new(config: TrackingConfig) -> Self {
        Places {
            config,
            ..Places::default()
        }
    }

    /// All places, best first.
    pub(super) fn all(&self) -> &[Place] {
        &self.kept
    }

    /// The believed place, if it is still kept.
    pub(super) fn believed(&self) -> Option<&Place> {
        let id = self.believed?;
        self.kept.iter().find(|place| place.id == id)
    }

    /// Reason why the last scan contradicts the believed place.
    pub(super) fn doubt(&self) -> Option<TrackReason> {
        self.believed()?.doubt
    }

    /// Keeps a single place, on the map with this number, at which a scan was taken, and believes
    /// it.
    pub(super) fn start_at(
        &mut self,
        seen: &[Seen<'_>],
        (map, predicted): (u32, (Pose, Matrix3<f64>)),
    ) {
        let fitted = seen[map as usize].settle(predicted);
        self.kept.clear();
        self.key_scans = 1;
        self.nowhere = -SELDOM;
        self.believed = Some(self.add((map, &fitted), 0.0).id);
    }

    /// Adds a place at which a hint expects the robot, while no other is kept.
    pub(super) fn expect(&mut self, seen: &[Seen<'_>], hint: Hint) {
        let seen = &seen[hint.map as usize];
        let fitted = seen.settle_turned(hint.at, seen.settle(hint.at));
        let place = self.add((hint.map, &fitted), 0.0);
        (place.predicted, place.is_expected) = (hint.at, true);
        // Places that the search finds elsewhere start with the weight of "nowhere".
        self.nowhere = self.nowhere_by(fitted.score) - EXPECTED;
        // A rival within the hint's ellipse is as likely as the hint itself.
        let log_weight = 0.0;
        self.expected = Some(WeighedHint { hint, log_weight });
    }

    /// Returns the place with the largest weight, in any order of the list.
    fn leading(&self) -> Option<&Place> {
        let places = self.kept.iter();
        places.reduce(|a, b| if b.log_weight > a.log_weight { b } else { a })
    }

    /// Log weight of "nowhere", comparable with that of the best place.
    pub(super) fn nowhere(&self) -> f64 {
        self.nowhere
    }

    /// Makes "nowhere" as likely as the best place, since the robot may have moved anywhere.
    pub(super) fn forget(&mut self) {
        self.nowhere = self.kept.first().map_or(0.0, |best| best.log_weight);
        self.was_searched = false;
    }

    /// Log odds of "nowhere" from the first scan at a place with this score.
    fn nowhere_by(&self, score: f64) -> f64 {
        let cap = self.config.scan_cap;
        nowhere_by_score(score, score, &self.config).clamp(-cap, cap)
    }

    /// Keeps another place, at a fit on the map with this number.
    fn add(&mut self, at: (u32, &Fitted), log_weight: f64) -> &mut Place {
        self.last_id += 1;
        self.kept.push(Place::born(self.last_id, at, log_weight));
        self.kept.last_mut().expect("a place was added")
    }

    /// Moves the believed place by a path and fits the scan there; `since_key` is the path since
    /// the last key scan. While the robot stands, scans that agree do not move the place, because
    /// their errors are those of the first scan.
    pub(super) fn follow(
        &mut self,
        seen: &[Seen<'_>],
        (path, since_key): (&DrivenPath, &DrivenPath),
    ) {
        let config = self.config;
        let mut kept = self.kept.iter_mut();
        let Some(place) = kept.find(|place| self.believed == Some(place.id)) else {
            return;
        };
        let seen = &seen[place.map as usize];
        let predicted = path.predict((place.pose, place.covariance), config.odometry_error);
        let mut fitted = seen.settle(predicted);
        if fitted.score < place.mean - config.restart_fall {
            fitted = seen.settle_turned(predicted, fitted);
        }
        place.predicted = predicted;
        let before = place.pose;
        place.set(&fitted);
        if since_key.is_rest() && fitted.off < GATE {
            place.pose = before;
        }
        place.judge(since_key, &config);
    }

    /// Weighs all places, and the candidates of the same scan, at a key scan. All places except the
    /// believed one have moved by `path` since the last key scan.
    pub(super) fn weigh(
        &mut self,
        seen: &[Seen<'_>],
        transitions: &[Transition],
        path: &DrivenPath,
    ) {
        let noise = self.config.odometry_error;
        for place in &mut self.kept {
            if self.believed != Some(place.id) {
                place.predicted = path.predict((place.pose, place.covariance), noise);
                place.set(&seen[place.map as usize].settle(place.predicted));
            } else {
                place.is_expected = false;
            }
        }
        self.snap();
        for place in &mut self.kept {
            place.judge(path, &self.config);
        }
        let (map, score) = self.best_score();
        let best = Best { score, map, seen };
        self.count(best);
        self.add_new(best);
        self.add_across(transitions, best);
        self.key_scans += 1;
        self.tidy();
    }

    /// Returns the highest score of any place, and its map.
    fn best_score(&self) -> (u32, f64) {
        let places = self.kept.iter().map(|place| (place.map, place.last));
        let candidates = self.candidates.iter();
        let candidates = candidates.map(|(map, candidate)| (*map, candidate.score));
        let higher = |a: (u32, f64), b: (u32, f64)| if b.1 > a.1 { b } else { a };
        places.chain(candidates).fold((0, 0.0), higher)
    }

    fn count(&mut self, best: Best<'_>) {
        // They were sorted at the key scan before, and no weight has changed since.
        let top = self.kept.first().map_or(0.0, |best| best.log_weight);
        let by_odometry = |place: &Place| BY_DEVIATION * place.off.min(GATE);
        let cap = self.config.scan_cap;
        for place in &mut self.kept {
            let against = best.against((place.map, place.last), cap);
            place.log_weight += -top - against - by_odometry(place);
            place.grow();
        }
        let first = self.leading().copied();
        self.nowhere -= top;
        if let Some(first) = first {
            // Odometry's evidence against the best place is already in its log odds.
            self.nowhere += first.nowhere.clamp(-cap, cap) - by_odometry(&first);
            self.nowhere = self.nowhere.max(first.log_weight - SELDOM);
        }
    }

    /// Sorts the places best first; drops those too far behind or without a free slot, and merges
    /// those that have met.
    fn tidy(&mut self) {
        // Ids grow, so that the older of two equal places comes first.
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
                // At the first key scan there are no old places.
                false => new == if self.key_scans > 1 { MAX_NEW } else { MAX },
            };
            if is_full || place.log_weight < top - FARTHEST_BEHIND {
                continue;
            }
            let met = self.kept[..count]
                .iter_mut()
                .find(|other| other.is_within((place.map, place.pose), MERGED_M, MERGED_RADIANS));
            if let Some(other) = met {
                other.crossed_from = other.crossed_from.or(place.crossed_from);
                if self.believed == Some(place.id) {
                    self.believed = Some(other.id);
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
