//! Places that a search found, added to the places that are kept.

use nalgebra::{Matrix3, Vector3};

use super::{Best, GATE, Places, SAME_M, SAME_RADIANS};
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
    /// Takes the places that a search found for this scan or, if there is a path since then, for an
    /// earlier one. Those of this scan are scored again, because a search gives only an upper bound
    /// of the score of places far behind.
    pub(crate) fn take(
        &mut self,
        seen: &[Seen<'_>],
        found: &[Candidate],
        since: Option<&DrivenPath>,
    ) {
        let noise = self.config.odometry_error;
        let found = found.iter().map(|candidate| {
            let (seen, at) = (&seen[candidate.map as usize], candidate.at());
            let fitted = match since {
                Some(path) => seen.settle(path.predict(at, noise)),
                None => Fitted {
                    pose: at.0,
                    covariance: at.1,
                    score: seen.score(at.0),
                    off: 0.0,
                },
            };
            (candidate.map, fitted)
        });
        self.candidates = found.collect();
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
    }

    /// Adds the candidates that are at none of the places kept. Each starts with the weight of
    /// "nowhere", to which it belonged until now, or less if earlier searches did not find it.
    pub(super) fn add_new(&mut self, best: Best<'_>) {
        let before = self.kept.len();
        let top = self.leading().map_or(0.0, |place| place.log_weight);
        let newborn = match self.was_searched {
            true => self.nowhere.min(top - LATE),
            false => self.nowhere,
        };
        self.was_searched |= !self.candidates.is_empty();
        let expected = self.expected.take();
        for (map, found) in std::mem::take(&mut self.candidates) {
            let at = (map, found.pose);
            let mut known = self.kept[..before].iter();
            if known.any(|place| place.is_within(at, SAME_M, SAME_RADIANS)) {
                continue;
            }
            let expected = expected.filter(|expected| expected.hint.holds(at));
            let unseen = expected.map_or(newborn, |expected| expected.log_weight);
            let log_weight = unseen - best.against((map, found.score), self.config.scan_cap);
            self.add((map, &found), log_weight).is_expected = expected.is_some();
        }
        // The first scan changes the weight of "nowhere" as a later one does.
        if before == 0
            && let Some(first) = self.leading()
        {
            self.nowhere += self.nowhere_by(first.last);
        }
    }
}
