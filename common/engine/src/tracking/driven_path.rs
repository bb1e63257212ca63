//! Motion measured by odometry, and its error.

use geometry::Pose;
use nalgebra::{Matrix3, Vector3};

use super::TrackingConfig;

/// A robot that turns back and forth takes a key scan after this many times the key distance.
const KEY_PATHS: f64 = 2.0;

/// A path of several steps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct DrivenPath {
    /// Pose of its end relative to its start.
    pub step: Pose,
    /// Length, in metres.
    pub path_m: f64,
    /// Sum of rotations to either side, in radians.
    pub turned: f64,
    /// True if a step is unknown; the robot is assumed to have stood during it.
    pub is_unknown: bool,
}

/// Standard deviations of odometry: at rest, for stamps that differ from the scans' (metres,
/// radians); per metre (metres, radians); per radian (radians). They are about the 95th percentile
/// of the drift of the odometry of eight robots over 5 m: 0.01 to 0.30 m/m and 0.2 to 4.9
/// degrees/m.
const AT_REST_M: f64 = 0.05;
const AT_REST: f64 = 1.5 * std::f64::consts::PI / 180.0;
const PER_METRE_M: f64 = 0.15;
const PER_METRE: f64 = 3.5 * std::f64::consts::PI / 180.0;
const PER_RADIAN: f64 = 0.15;

/// Largest total motion of a standing robot, in metres and radians.
const REST_M: f64 = 0.005;
const REST_RADIANS: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// Standard deviations of an unknown step between two scans, in metres and radians.
const UNKNOWN_M: f64 = 0.4;
const UNKNOWN: f64 = 30.0 * std::f64::consts::PI / 180.0;

impl DrivenPath {
    /// Appends a step, `None` if it is unknown.
    pub(super) fn add(&mut self, step: Option<Pose>) {
        let Some(step) = step else {
            self.is_unknown = true;
            return;
        };
        self.step = self.step.then(step);
        self.path_m += step.x.hypot(step.y);
        self.turned += step.yaw.abs();
    }

    /// Appends another path.
    pub(super) fn extend(mut self, by: &DrivenPath) -> Self {
        self.step = self.step.then(by.step);
        self.path_m += by.path_m;
        self.turned += by.turned;
        self.is_unknown |= by.is_unknown;
        self
    }

    /// True if the path is long enough for the next key scan.
    pub(super) fn is_far(&self, config: &TrackingConfig) -> bool {
        self.step.x.hypot(self.step.y) >= config.key_m
            || self.step.yaw.abs() >= config.key_deg.to_radians()
            || self.path_m > KEY_PATHS * config.key_m
    }

    /// True if the robot stood: odometry moved by less than its rounding.
    pub(super) fn is_rest(&self) -> bool {
        !self.is_unknown && self.path_m < REST_M && self.turned < REST_RADIANS
    }

    /// Predicts a pose and its covariance in the map at the end of the path. `noise` scales the
    /// standard deviations.
    pub(super) fn predict(
        &self,
        (pose, covariance): (Pose, Matrix3<f64>),
        noise: f64,
    ) -> (Pose, Matrix3<f64>) {
        let (predicted, carried) = self.carry((pose, covariance), noise);
        let at_rest = [AT_REST_M, AT_REST_M, AT_REST].map(|d| (noise * d).powi(2));
        (predicted, carried + Matrix3::from_diagonal(&at_rest.into()))
    }

    /// Carries a pose and its covariance by odometry alone, without a scan to compare, so that no
    /// error of differing stamps is added.
    pub(super) fn carry(
        &self,
        (pose, covariance): (Pose, Matrix3<f64>),
        noise: f64,
    ) -> (Pose, Matrix3<f64>) {
        let predicted = pose.then(self.step);
        let (dx, dy) = (predicted.x - pose.x, predicted.y - pose.y);
        let jacobian = Matrix3::new(1.0, 0.0, -dy, 0.0, 1.0, dx, 0.0, 0.0, 1.0);
        let carried = jacobian * covariance * jacobian.transpose();
        (predicted, carried + self.error(noise))
    }

    fn error(&self, noise: f64) -> Matrix3<f64> {
        let hole = if self.is_unknown { 1.0 } else { 0.0 };
        let squares = |deviations: [f64; 2]| deviations.iter().map(|d| (noise * d).powi(2)).sum();
        let position: f64 = squares([PER_METRE_M * self.path_m, hole * UNKNOWN_M]);
        let heading: f64 = squares([PER_RADIAN * self.turned, PER_METRE * self.path_m])
            + (hole * noise * UNKNOWN).powi(2);
        Matrix3::from_diagonal(&Vector3::new(position, position, heading))
    }
}
