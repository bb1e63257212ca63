//! Places that a search found, added to the places that are kept.

use nalgebra::{Matrix3, Vector3};

use super::{Best, GATE, Place, Places, SAME_M, SAME_RADIANS};
use crate::tracking::driven_path::DrivenPath;
use crate::tracking::place::Candidate;
use crate::tracking::seen::{Fitted, Seen, information, squared_deviations};

/// Standard deviations that a search adds to a prediction in the gate, in metres and radians: half
/// its cell and heading, and the steps of its fit.
const GATE_M: f64 = 0.1;
const GATE_RADIANS: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Score by which a candidate in the gate must be better to replace the place's pose: a constant,
/// and an amount per squared deviation.
const SNAP: f64 = 0.02;
const SNAP_BY_DEVIATION: f64 = 0.01;

/// Log odds against a place that earlier searches did not find.
const LATE: f64 = 3.5;

impl Places {
    /// Takes the places that a search found for this scan. They are scored again, because a search
    /// gives only an upper bound of the score of places far behind.
    pub(crate) fn take(&mut self, seen: &[Seen<'_>], found: &[Candidate]) {
        self.candidates.clear();
        self.candidates.extend(found.iter().map(|found| {
            let (pose, covariance) = found.at();
            let fitted = Fitted {
                pose,
                covariance,
                score: seen[found.map as usize].score(pose),
                off: 0.0,
            };
            (found.map, fitted)
        }));
    }

    /// Takes the places that a search found for an earlier scan; `path` is the path since then.
    pub(crate) fn take_ahead(&mut self, seen: &[Seen<'_>], path: &DrivenPath, found: &[Candidate]) {
        let noise = self.config.odometry_error;
        self.candidates.clear();
        self.candidates.extend(found.iter().map(|candidate| {
            let seen = &seen[candidate.map as usize];
            let settled = seen.settle(path.predict(candidate.at(), noise));
            (candidate.map, settled)
        }));
    }

    /// Moves places to candidates that confirm them and fit better.
    pub(super) fn snap(&mut self) {
        let more = Vector3::new(GATE_M, GATE_M, GATE_RADIANS).map(|d| d * d);
        for place in &mut self.kept {
            let (pose, covariance) = place.predicted;
            let known = information(&(covariance + Matrix3::from_diagonal(&more)));
            let mut best: Option<(f64, f64, &Fitted)> = None;
            let on_map = self.candidates.iter().filter(|(map, _)| *map == place.map);
            for (_, candidate) in on_map {
                let off = squared_deviations(candidate.pose, pose, &known);
                let worth = candidate.score - SNAP_BY_DEVIATION * off;
                if off < GATE && best.is_none_or(|(most, _, _)| worth > most) {
                    best = Some((worth, off, candidate));
                }
            }
            if let Some((worth, off, candidate)) = best
                && worth > place.last + SNAP
            {
                place.set(&Fitted { off, ..*candidate });
            }
        }
        let places = &self.kept;
        self.is_known.clear();
        self.is_known
            .extend(self.candidates.iter().map(|&(map, candidate)| {
                let at = (map, candidate.pose);
                places
                    .iter()
                    .any(|place| place.is_within(at, SAME_M, SAME_RADIANS))
            }));
    }

    /// Adds the candidates that are at none of the places kept. Each starts with the weight of
    /// "nowhere", to which it belonged until now, or less if earlier searches did not find it.
    pub(super) fn add_new(&mut self, best: Best<'_>) {
        let is_first = self.kept.is_empty();
        let top = self.leading().map_or(0.0, |place| place.log_weight);
        let newborn = match self.was_searched {
            true => self.nowhere.min(top - LATE),
            false => self.nowhere,
        };
        self.was_searched |= !self.candidates.is_empty();
        let expected = self.expected.take();
        for i in 0..self.candidates.len() {
            if self.is_known[i] {
                continue;
            }
            let (map, found) = self.candidates[i];
            let expected = expected.filter(|expected| expected.hint.holds((map, found.pose)));
            let before = expected.map_or(newborn, |expected| expected.log_weight);
            let log_weight = before - self.against(best, (map, found.score));
            let id = self.new_id();
            self.kept.push(Place {
                is_expected: expected.is_some(),
                ..Place::born(id, (map, &found), log_weight)
            });
        }
        // The first scan changes the weight of "nowhere" as a later one does.
        if let Some(score) = self.leading().filter(|_| is_first).map(|place| place.last) {
            self.nowhere += self.nowhere_by(score);
        }
    }
}
