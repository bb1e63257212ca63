//! The hypothesis "nowhere": the robot is at none of the places that are kept, but elsewhere,
//! on another map, or its sensors do not say what they should.
//!
//! It has a weight as each place has. A look speaks for it as far as the scan fits no better
//! than scans do where they do not belong, as far as it fits worse than scans did there before,
//! or as far as the place moved otherwise than odometry says, whichever says most.

use geometry::Pose;
use messages::TrackReason;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::Place;
use super::seen::{information, squared_deviations};

/// Score at which a place and "nowhere" are equally likely, and the score above it that makes
/// "nowhere" less likely by a factor of e.
const EVEN_SCORE: f64 = 0.5;
const SCORE_SCALE: f64 = 0.16;

/// Squared deviations from odometry that speak as much for "nowhere" as for the place: four
/// standard deviations; and how much more of them make it more likely by a factor of e.
const EVEN_DEVIATION: f64 = 16.0;
const DEVIATION_SCALE: f64 = 5.0;

/// A prediction with larger standard deviations, metres and radians, does not tell places
/// apart: two of them are what distinguishes places.
const BLIND_M: f64 = 0.5;
const BLIND_RADIANS: f64 = 7.5 * std::f64::consts::PI / 180.0;

/// Log odds of "nowhere" by the score of a scan at the best place, where scans before had this
/// mean.
pub(super) fn nowhere_by_score(score: f64, mean: f64, config: &TrackingConfig) -> f64 {
    (EVEN_SCORE.max(mean - config.doubt_fall) - score) / SCORE_SCALE
}

/// The most that a scan says for one place against another, which fits worse than the best with
/// this score: where that fits badly too, what is seen may not be on the map, and the scan may
/// look like that anywhere.
pub(super) fn explained(best: f64) -> f64 {
    ((best - EVEN_SCORE) / SCORE_SCALE).exp().ln_1p()
}

impl Place {
    /// Judges the last fit by its score and by how the place moved since its anchor, along
    /// which odometry went `path` since the last key scan. A scan that the robot sees from
    /// where it saw the one before brings nothing new for the place.
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

    /// Whether the robot, gone this way from here without a scan, may be at more than one place.
    pub(super) fn is_blind_after(&self, path: &DrivenPath, noise: f64) -> bool {
        is_blind(&path.predict((self.pose, self.covariance), noise))
    }
}

/// Whether a prediction leaves more than one place possible.
pub(super) fn is_blind((_, covariance): &(Pose, Matrix3<f64>)) -> bool {
    let position = covariance.fixed_view::<2, 2>(0, 0).symmetric_eigenvalues();
    position.max() > BLIND_M.powi(2) || covariance[(2, 2)] > BLIND_RADIANS.powi(2)
}
