//! A scan on the map, fitted near an expected pose.

use geometry::{Pose, wrap_angle};
use nalgebra::{Matrix3, Vector3};

use crate::fit::{DistanceField, Ends, Expected, FitConfig, GridPose};

/// A scan, and a map on which it may have been taken.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Distance field of the map.
    pub distance_field: &'a DistanceField,
    /// Beams of the scan.
    pub ends: &'a Ends,
    /// Settings for judging the beams.
    pub fit: &'a FitConfig,
}

/// A pose to which a scan was fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    pub pose: Pose,
    pub covariance: Matrix3<f64>,
    /// Score of the scan there, at most 1.
    pub score: f64,
    /// Squared deviation from the expected pose.
    pub off: f64,
}

/// Reaches of the fit from a prediction, and from a guess, in standard deviations.
const NEAR: [f64; 2] = [4.0, 2.0];
const WIDE: [f64; 2] = [6.0, 2.0];

/// Headings from which a fit is tried again, in degrees from the prediction: robots skid in turns,
/// and a fit reaches only some five degrees.
const TURNS_DEG: [f64; 10] = [-4.0, 4.0, -8.0, 8.0, -12.0, 12.0, -18.0, 18.0, -25.0, 25.0];

/// Fits from a guess are drawn to the guess with a tenth of the prediction's information, and lose
/// this much score per squared deviation from the prediction: four standard deviations cost as much
/// as the scores of one place vary from scan to scan.
const GUESS_SHARE: f64 = 0.1;
const SCORE_BY_DEVIATION: f64 = 0.004;

/// Error of a fit that remains however many scans agree, in metres and radians: maps err by some
/// centimetres, in the same direction for all scans of a place.
const MAP_ERROR_M: f64 = 0.03;
const MAP_ERROR: f64 = 0.4 * std::f64::consts::PI / 180.0;

/// Adds the error of a map to a covariance; a drawn map errs by `drawn_m` metres more.
pub(super) fn with_map_error(covariance: Matrix3<f64>, drawn_m: f64) -> Matrix3<f64> {
    let position = MAP_ERROR_M.hypot(drawn_m);
    let squares = [position, position, MAP_ERROR].map(|d| d * d);
    covariance + Matrix3::from_diagonal(&Vector3::from(squares))
}

/// Returns the inverse of a covariance, or zeros if it is singular.
pub(super) fn information(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    covariance.try_inverse().unwrap_or_else(Matrix3::zeros)
}

/// Squared deviation (Mahalanobis distance) of one pose from another.
pub(super) fn squared_deviations(of: Pose, from: Pose, information: &Matrix3<f64>) -> f64 {
    let off = Vector3::new(of.x - from.x, of.y - from.y, wrap_angle(of.yaw - from.yaw));
    off.dot(&(information * off))
}

impl Seen<'_> {
    /// Fits the scan from a prediction.
    pub(super) fn settle(&self, (pose, covariance): (Pose, Matrix3<f64>)) -> Fitted {
        let known = information(&covariance);
        self.fit(pose, (pose, known), (NEAR, known))
    }

    /// Fits the scan from headings around a prediction as well, and returns the best fit by score
    /// and deviation from the prediction.
    pub(super) fn settle_turned(&self, predicted: (Pose, Matrix3<f64>), first: Fitted) -> Fitted {
        let (pose, known) = (predicted.0, information(&predicted.1));
        let worth = |fitted: &Fitted| fitted.score - SCORE_BY_DEVIATION * fitted.off;
        let guesses = TURNS_DEG.iter().map(|degrees| {
            let turned = Pose {
                yaw: pose.yaw + degrees.to_radians(),
                ..pose
            };
            self.fit(turned, (turned, GUESS_SHARE * known), (WIDE, known))
        });
        let mut best = first;
        for guess in guesses {
            let guess = Fitted {
                off: squared_deviations(guess.pose, pose, &known),
                ..guess
            };
            if worth(&guess) > worth(&best) {
                best = guess;
            }
        }
        best
    }

    /// Score of the scan at a pose, at most 1.
    pub(super) fn score(&self, pose: Pose) -> f64 {
        let at = GridPose::of(self.distance_field.frame, pose);
        self.distance_field.score(self.ends, at, self.fit)
    }

    fn fit(
        &self,
        start: Pose,
        (mean, pull): (Pose, Matrix3<f64>),
        (reaches, known): ([f64; 2], Matrix3<f64>),
    ) -> Fitted {
        let frame = self.distance_field.frame;
        let map_from_cells = frame.metres_from_cells();
        let cells_from_map = map_from_cells
            .try_inverse()
            .unwrap_or_else(Matrix3::identity);
        let expected = Expected {
            pose: GridPose::of(frame, mean),
            information: map_from_cells.transpose() * pull * map_from_cells,
        };
        let start = GridPose::of(frame, start);
        let how = (&expected, reaches);
        let refined = self
            .distance_field
            .refine_expected(self.ends, start, how, self.fit);
        let measured = cells_from_map.transpose() * refined.information() * cells_from_map;
        let at = refined.pose;
        let pose = frame.map_from_cells(at.x, at.y, at.heading);
        let covariance = information(&(measured + known));
        Fitted {
            pose,
            covariance: with_map_error(covariance, self.distance_field.drawn_error_m()),
            score: self.distance_field.score(self.ends, at, self.fit),
            off: squared_deviations(pose, mean, &known),
        }
    }
}
