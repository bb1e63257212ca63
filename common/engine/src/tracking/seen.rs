//! A scan on the map: where it fits best near what was expected.

use geometry::{Pose, wrap_angle};
use nalgebra::{Matrix3, Vector3};

use crate::fit::{DistanceField, Ends, Expected, FitConfig, GridPose};

/// A scan, and the map on which it was taken.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// The map.
    pub distance_field: &'a DistanceField,
    /// The beams of the scan.
    pub ends: &'a Ends,
    /// How they are judged.
    pub fit: &'a FitConfig,
}

/// A pose that a scan was fitted at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    pub pose: Pose,
    pub covariance: Matrix3<f64>,
    /// How well the scan fits there, at most 1.
    pub score: f64,
    /// How far it lies from what was expected, in squared deviations.
    pub off: f64,
}

/// Reaches of the fit from a prediction, and from a guess, standard deviations.
const NEAR: [f64; 2] = [4.0, 2.0];
const WIDE: [f64; 2] = [6.0, 2.0];

/// Headings from which a fit is tried again, degrees from the prediction: robots skid
/// in turns, and a fit reaches some five degrees.
const TURNS_DEG: [f64; 10] = [-4.0, 4.0, -8.0, 8.0, -12.0, 12.0, -18.0, 18.0, -25.0, 25.0];

/// Such fits are drawn to the prediction with a tenth of its information, and lose so
/// much of their score by each squared deviation from it: four deviations cost as
/// much as the scores of one place differ from scan to scan.
const GUESS_SHARE: f64 = 0.1;
const SCORE_BY_DEVIATION: f64 = 0.004;

/// What a fit errs by in addition, however many scans agree: maps err by some
/// centimetres, and in the same direction for all scans of a place.
const MAP_ERROR_M: f64 = 0.03;
const MAP_ERROR: f64 = 0.4 * std::f64::consts::PI / 180.0;

/// A covariance with what a map errs by in addition, one that was drawn by this many
/// metres more.
pub(super) fn with_map_error(covariance: Matrix3<f64>, drawn_m: f64) -> Matrix3<f64> {
    let position = MAP_ERROR_M.hypot(drawn_m);
    let squares = [position, position, MAP_ERROR].map(|d| d * d);
    covariance + Matrix3::from_diagonal(&Vector3::from(squares))
}

/// The inverse of a covariance.
pub(super) fn information(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    covariance.try_inverse().unwrap_or_else(Matrix3::zeros)
}

/// How far a pose lies from another one, in squared deviations.
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

    /// Fits the scan from headings around a prediction too; the best by score and by
    /// how far it lies from the prediction.
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

    /// How well the scan fits at a pose, at most 1.
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
