//! The hypothesis "nowhere": the robot is at none of the places kept but elsewhere, on another map,
//! or its sensors are wrong.
//!
//! It has a weight, as each place has. A scan supports it by the largest of three amounts: how
//! close the score is to that of scans at wrong places, how far it is below the mean of earlier
//! scans there, and how much the motion of the place differs from odometry.

use geometry::Pose;
use messages::TrackReason;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::Place;
use super::seen::{information, squared_deviations};

/// Score at which a place and "nowhere" are equally likely, and the increase of score that makes
/// "nowhere" less likely by a factor of e.
const EVEN_SCORE: f64 = 0.5;
const SCORE_SCALE: f64 = 0.16;

/// Squared deviation from odometry at which a place and "nowhere" are equally likely (four standard
/// deviations), and the increase that makes "nowhere" more likely by a factor of e.
const EVEN_DEVIATION: f64 = 16.0;
const DEVIATION_SCALE: f64 = 5.0;

/// Largest standard deviations of a prediction, in metres and radians, that tell places apart: half
/// of the distance at which places are distinct.
const BLIND_M: f64 = 0.5;
const BLIND_RADIANS: f64 = 7.5 * std::f64::consts::PI / 180.0;

/// Log odds of "nowhere" by the score of a scan at the best place, given the mean score of earlier
/// scans there.
pub(super) fn nowhere_by_score(score: f64, mean: f64, config: &TrackingConfig) -> f64 {
    (EVEN_SCORE.max(mean - config.doubt_fall) - score) / SCORE_SCALE
}

/// Maximum evidence of a scan for the best place, which has this score, against another. If even
/// the best place fits badly, the scan may show something that is not on the map and may fit as
/// badly anywhere.
pub(super) fn explained(best: f64) -> f64 {
    ((best - EVEN_SCORE) / SCORE_SCALE).exp().ln_1p()
}

impl Place {
    /// Judges the last fit by its score and by the motion of the place since its anchor, compared
    /// with odometry; `path` is the path since the last key scan. A scan from the same pose as the
    /// one before adds nothing for the place.
    pub(super) fn judge(&mut self, path: &DrivenPath, config: &TrackingConfig) {
        self.since_anchor = self.until_key.extend(path);
        let (expected, covariance) = self
            .since_anchor
            .predict(self.anchor, config.odometry_error);
        let off = squared_deviations(self.pose, expected, &information(&covariance));
        let from = self.anchor.0;
        let metres = from.distance_to(self.pose) / config.key_m.max(1e-9);
        let turned = from.angle_to(self.pose) / config.key_deg.to_radians().max(1e-9);
        self.novelty = metres.hypot(turned).min(1.0);
        let by_scan = nowhere_by_score(self.last, self.mean, config);
        let by_scan = match by_scan < 0.0 {
            true => by_scan * self.novelty,
            false => by_scan,
        };
        let by_odometry = (off - EVEN_DEVIATION) / DEVIATION_SCALE;
        self.nowhere = by_scan.max(by_odometry);
        self.doubt = match () {
            () if self.nowhere <= 0.0 => None,
            () if by_odometry > by_scan => Some(TrackReason::OdometryJump),
            () => Some(TrackReason::PoorFit),
        };
    }

    /// True if the robot may be at more than one place after this path without a scan.
    pub(super) fn is_blind_after(&self, path: &DrivenPath, noise: f64) -> bool {
        is_blind(&path.predict((self.pose, self.covariance), noise))
    }
}

/// True if a prediction leaves more than one place possible.
pub(super) fn is_blind((_, covariance): &(Pose, Matrix3<f64>)) -> bool {
    let position = covariance.fixed_view::<2, 2>(0, 0).symmetric_eigenvalues();
    position.max() > BLIND_M.powi(2) || covariance[(2, 2)] > BLIND_RADIANS.powi(2)
}
