//! Hints: poses at which an operator or another process expects the robot, in addition to the
//! believed place.

use geometry::{Covariance, Pose};
use nalgebra::Matrix3;

use super::{Best, EXPECTED, Fitted, GATE, Places};
use crate::tracking::driven_path::DrivenPath;
use crate::tracking::seen::{Seen, information, squared_deviations};

/// Poses this near a hint agree with it, in metres and radians; so do those in its 95 % ellipse
/// (squared deviation over three axes).
const NEAR_M: f64 = 0.5;
const NEAR_RADIANS: f64 = 10.0 * std::f64::consts::PI / 180.0;
const WITHIN_95: f64 = 7.8;

/// Variation of the score of one place from scan to scan.
const BETTER: f64 = 0.05;

/// A pose at which an operator or another process expects the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hint {
    /// Number of the map.
    pub map: u32,
    /// Pose and covariance in the map.
    pub at: (Pose, Matrix3<f64>),
    /// Path of the robot since the hint was given.
    pub since: DrivenPath,
}

impl Hint {
    pub(crate) fn new((map, pose): (u32, Pose), covariance: Covariance) -> Self {
        Hint {
            map,
            at: (pose, covariance.into()),
            since: DrivenPath::default(),
        }
    }

    /// True if a pose on a map agrees with the hint.
    pub(crate) fn is_near(&self, (map, pose): (u32, Pose)) -> bool {
        self.map == map
            && (self.at.0.is_within(pose, NEAR_M, NEAR_RADIANS) || self.off(pose) < WITHIN_95)
    }

    /// True if a pose on a map is in the hint's ellipse, widened by the error of a search.
    pub(super) fn holds(&self, (map, pose): (u32, Pose)) -> bool {
        self.map == map && self.off(pose) < GATE
    }

    fn off(&self, pose: Pose) -> f64 {
        squared_deviations(pose, self.at.0, &information(&self.at.1))
    }

    /// Returns the hint moved along the path since it was given.
    #[must_use]
    pub(crate) fn moved(&self, noise: f64) -> Self {
        Hint {
            at: self.since.predict(self.at, noise),
            since: DrivenPath::default(),
            ..*self
        }
    }
}

/// A hint that is as likely as other places, and the initial log weight of places in its ellipse.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeighedHint {
    pub(super) hint: Hint,
    pub(super) log_weight: f64,
}

impl Places {
    /// True if, by the last scan alone, the robot may be at a hint rather than at the believed
    /// place.
    pub(crate) fn may_be_at(&self, hint: &Hint, seen: &[Seen<'_>]) -> bool {
        self.fit_hint(hint, seen).is_some()
    }

    /// Makes the next [`Places::weigh`] weigh a hint against the believed place. Other places in
    /// its ellipse, kept or found by a search, become as likely as the hint.
    pub(crate) fn expect_beside(&mut self, hint: Hint, seen: &[Seen<'_>]) {
        if let Some((fitted, log_weight)) = self.fit_hint(&hint, seen) {
            self.candidates.push((hint.map, fitted));
            for place in &mut self.kept {
                if self.believed != Some(place.id) && hint.holds((place.map, place.pose)) {
                    place.log_weight = place.log_weight.max(log_weight);
                    place.is_expected = true;
                }
            }
            self.expected = Some(WeighedHint { hint, log_weight });
        }
    }

    /// Fits the scan at a hint and returns the fit and its log weight. `None` if the scan is more
    /// evidence against the hint than the hint is for itself; that evidence is not capped, since
    /// earlier scans have confirmed the believed place.
    fn fit_hint(&self, hint: &Hint, seen: &[Seen<'_>]) -> Option<(Fitted, f64)> {
        let believed = self.believed()?;
        let on_map = &seen[hint.map as usize];
        let fitted = on_map.settle_turned(hint.at, on_map.settle(hint.at));
        // The hint draws a fit to itself, so the fit is repeated from there; fits of the search
        // count too.
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
        let log_weight = EXPECTED - self.nowhere_by(fitted.score) - best.behind(at);
        // A pose near the believed place is a different answer only if the scan fits better there.
        let is_other = believed.is_apart_from((hint.map, fitted.pose))
            || fitted.score > believed.last + BETTER;
        let with_scan = log_weight + best.against(at, self.config.scan_cap);
        (is_other && log_weight > 0.0).then_some((fitted, with_scan))
    }
}
