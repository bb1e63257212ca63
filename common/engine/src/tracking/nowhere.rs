//! The hypothesis "nowhere": the robot is at none of the places, on another map, or its
//! sensors do not say what they should.
//!
//! It has a weight as each place has. A look speaks for it as far as the scan fits no better
//! than scans do where they do not belong, or as far as the place moved otherwise than
//! odometry says, whichever says more.

use geometry::Pose;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::place::Place;
use super::seen::{information, squared_deviations};

/// Score at which a place and "nowhere" are equally likely, and the score above it that makes
/// "nowhere" less likely by a factor of e: as for single scans (`--even-score`,
/// `--score-scale`).
const EVEN_SCORE: f64 = 0.55;
const SCORE_SCALE: f64 = 0.06;

/// Squared deviations from odometry that speak as much for "nowhere" as for the place: four
/// standard deviations.
const EVEN_DEVIATION: f64 = 16.0;

/// A prediction with larger standard deviations, metres and radians, does not tell places
/// apart: two of them are what distinguishes places.
const BLIND_M: f64 = 0.5;
const BLIND_RADIANS: f64 = 7.5 * std::f64::consts::PI / 180.0;

/// Log odds of "nowhere" by the score of a scan at the best place.
pub(super) fn nowhere_by_score(score: f64) -> f64 {
    (EVEN_SCORE - score) / SCORE_SCALE
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
        let by_scan = nowhere_by_score(self.last);
        let by_scan = match by_scan < 0.0 {
            true => by_scan * self.novelty,
            false => by_scan,
        };
        self.nowhere = by_scan.max(0.5 * (off - EVEN_DEVIATION));
    }
}

/// Whether a prediction leaves more than one place possible.
pub(super) fn is_blind((_, covariance): &(Pose, Matrix3<f64>)) -> bool {
    let position = covariance.fixed_view::<2, 2>(0, 0).symmetric_eigenvalues();
    position.max() > BLIND_M.powi(2) || covariance[(2, 2)] > BLIND_RADIANS.powi(2)
}
