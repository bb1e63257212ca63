//! A pose at which somebody says that the robot is, beside the place that is believed.

use geometry::{Covariance, Pose};
use nalgebra::Matrix3;

use super::{Best, EXPECTED, Fitted, GATE, Places};
use crate::tracking::driven_path::DrivenPath;
use crate::tracking::seen::{Seen, information, squared_deviations};

/// Poses so near a hint are what it says, metres and radians; so are those within 95 % of its
/// ellipse, squared deviations of three axes.
const NEAR_M: f64 = 0.5;
const NEAR_RADIANS: f64 = 10.0 * std::f64::consts::PI / 180.0;
const WITHIN_95: f64 = 7.8;

/// Scores of one place differ by less from scan to scan.
const BETTER: f64 = 0.05;

/// A pose at which somebody says that the robot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::tracking) struct Hint {
    /// Number of the map.
    pub map: u32,
    /// The pose and its covariance.
    pub at: (Pose, Matrix3<f64>),
}

impl Hint {
    pub(in crate::tracking) fn new((map, pose): (u32, Pose), covariance: Covariance) -> Self {
        Hint {
            map,
            at: (pose, covariance.0),
        }
    }

    /// Whether it says nothing else than that the robot is at this pose of a map.
    pub(in crate::tracking) fn is_near(&self, (map, pose): (u32, Pose)) -> bool {
        self.map == map
            && (self.at.0.is_within(pose, NEAR_M, NEAR_RADIANS) || self.off(pose) < WITHIN_95)
    }

    /// Whether a pose lies in its ellipse, as wide as a search may be off.
    pub(super) fn holds(&self, (map, pose): (u32, Pose)) -> bool {
        self.map == map && self.off(pose) < GATE
    }

    fn off(&self, pose: Pose) -> f64 {
        squared_deviations(pose, self.at.0, &information(&self.at.1))
    }

    /// The hint after the robot went this way.
    #[must_use]
    pub(in crate::tracking) fn after(&self, path: &DrivenPath, noise: f64) -> Self {
        Hint {
            at: path.predict(self.at, noise),
            ..*self
        }
    }
}

/// A hint that is as likely as other places, and the log weight with which places in its
/// ellipse begin.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeighedHint {
    pub(super) hint: Hint,
    pub(super) log_weight: f64,
}

impl Places {
    /// Whether the robot may be at a hint rather than at the place of this number, by the last
    /// scan alone.
    pub(in crate::tracking) fn may_be_at(
        &self,
        hint: &Hint,
        seen: &[Seen<'_>],
        believed: u32,
    ) -> bool {
        self.fit_hint(hint, seen, believed).is_some()
    }

    /// Has the next [`Places::weigh`] weigh a hint against the place of this number. Other places
    /// in its ellipse, whether they are kept or a search found them, are as likely.
    pub(in crate::tracking) fn expect_beside(
        &mut self,
        hint: Hint,
        seen: &[Seen<'_>],
        believed: u32,
    ) {
        if let Some((fitted, log_weight)) = self.fit_hint(&hint, seen, believed) {
            self.candidates.push((hint.map, fitted));
            let others = self.kept.iter_mut().filter(|place| place.id != believed);
            for place in others.filter(|place| hint.holds((place.map, place.pose))) {
                place.log_weight = place.log_weight.max(log_weight);
                place.is_expected = true;
            }
            self.expected = Some(WeighedHint { hint, log_weight });
        }
    }

    /// Where the scan fits at a hint, and the log weight of places there before it; none where
    /// the scan says more against it than the hint says for it. The whole of that counts: the
    /// place that is believed has been confirmed by scans before.
    fn fit_hint(&self, hint: &Hint, seen: &[Seen<'_>], believed: u32) -> Option<(Fitted, f64)> {
        let believed = self.get(believed)?;
        let on_map = &seen[hint.map as usize];
        let fitted = on_map.settle_turned(hint.at, on_map.settle(hint.at));
        // Once more from there, for the hint draws a fit to itself; or where a search found it.
        let again = on_map.settle((fitted.pose, hint.at.1));
        let found = self.candidates.iter().filter(|(map, _)| *map == hint.map);
        let found = found.map(|(_, found)| *found).chain([again]);
        let found = found.filter(|found| hint.holds((hint.map, found.pose)));
        let fitted = found.fold(fitted, |best, found| match found.score > best.score {
            true => found,
            false => best,
        });
        let at = (hint.map, fitted.score);
        let (map, score) = match fitted.score > believed.last {
            true => at,
            false => (believed.map, believed.last),
        };
        let best = Best { score, map, seen };
        let log_weight = EXPECTED - self.nowhere_by(fitted.score) - self.behind(best, at);
        // Near the place that is believed it is another answer where the scan fits better.
        let is_other = believed.is_apart_from((hint.map, fitted.pose))
            || fitted.score > believed.last + BETTER;
        let with_scan = log_weight + self.against(best, at);
        (is_other && log_weight > 0.0).then_some((fitted, with_scan))
    }
}
