//! Motion of the robot without odometry. Each scan is matched to a reference scan, which is kept
//! until the robot is some distance away, so that errors do not add up from scan to scan (Lu and
//! Milios, "Robot pose estimation in unknown environments by matching 2D range scans", J.
//! Intelligent and Robotic Systems 18, 1997).

use geometry::Pose;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::seen::Seen;
use crate::EngineError;
use crate::fit::{DistanceField, End, Ends, FitConfig};
use crate::grid::{CellRules, GridFrame};

/// Smallest score of a usable match. Below it, two fifths of the beams see something that the
/// reference scan did not, or the robot was carried away.
const MIN_SCORE: f64 = 0.6;

/// Score below which a match is tried again from other headings.
const SURE_SCORE: f64 = 0.8;

/// Largest distance of beam ends that are used, in cells: beyond it beams are too far apart, and a
/// map of that size takes some milliseconds to prepare.
const FARTHEST: f64 = 400.0;

/// Matches scans to an earlier one.
#[derive(Debug, Clone, Default)]
pub struct ScanMatcher {
    /// The reference scan, as a map whose origin is the pose of that scan.
    reference: Option<DistanceField>,
    /// Motion from the reference scan to the last scan.
    gone: Pose,
    /// Motion of the robot to the last scan, used as the prediction of the next.
    step: Pose,
}

impl ScanMatcher {
    /// Returns the motion of the target frame since the scan before: by odometry or, without it, by
    /// matching the scans. `None` if they do not match or there was no scan before.
    pub(super) fn moved(
        &mut self,
        seen: &Seen<'_>,
        by_odometry: Option<Pose>,
        config: &TrackingConfig,
    ) -> Option<Pose> {
        if by_odometry.is_some() {
            self.reference = None;
            return by_odometry;
        }
        let resolution_m = seen.distance_field.frame.resolution_m;
        self.step(seen.ends, (resolution_m, seen.fit), config)
    }

    /// Returns the motion of the target frame since the scan before, by matching the scans; `None`
    /// if they do not match or there was no scan before. The ends are in cells of `resolution_m`
    /// metres.
    pub fn step(
        &mut self,
        ends: &Ends,
        (resolution_m, fit): (f64, &FitConfig),
        config: &TrackingConfig,
    ) -> Option<Pose> {
        let step = self.matched(ends, fit);
        self.step = step.unwrap_or(Pose::IDENTITY);
        self.gone = self.gone.then(self.step);
        let is_near = self.gone.x.hypot(self.gone.y) < config.key_m
            && self.gone.yaw.abs() < config.key_deg.to_radians();
        if step.is_none() || !is_near {
            self.reference = around(ends, resolution_m).ok();
            self.gone = Pose::IDENTITY;
        }
        step
    }

    fn matched(&self, ends: &Ends, fit: &FitConfig) -> Option<Pose> {
        let before = Seen {
            distance_field: self.reference.as_ref()?,
            ends,
            fit,
        };
        let unknown = DrivenPath {
            is_unknown: true,
            step: self.step,
            ..DrivenPath::default()
        };
        let predicted = unknown.predict((self.gone, Matrix3::zeros()), 1.0);
        // The other ends are outside the map.
        let near = near_share(ends);
        let mut fitted = before.settle(predicted);
        if fitted.score < SURE_SCORE * near {
            fitted = before.settle_turned(predicted, fitted);
        }
        let step = self.gone.inverse().then(fitted.pose);
        (fitted.score >= MIN_SCORE * near).then_some(step)
    }
}

/// Makes a map of the ends of a scan, with cells of this many metres.
fn around(ends: &Ends, resolution_m: f64) -> Result<DistanceField, EngineError> {
    let ends = || ends.ends.iter().map(point).filter(is_near);
    let reach = ends().fold(1.0, |reach: f64, (x, y)| reach.max(x.abs()).max(y.abs()));
    let half = reach as usize + 2;
    let side = 2 * half;
    let mut occupancy = vec![0; side * side];
    for (x, y) in ends() {
        let cell = |along: f64| (along + half as f64) as usize;
        occupancy[cell(y) * side + cell(x)] = 100;
    }
    let corner = -(half as f64) * resolution_m;
    let frame = GridFrame::new(resolution_m, Pose::new(corner, corner, 0.0));
    DistanceField::new(frame, (side, side), &occupancy, CellRules::default())
}

/// Share of the near ends in the total weight, at least 0.1, so that a match of a tenth of the
/// beams does not count as one of all.
fn near_share(ends: &Ends) -> f64 {
    let near = ends.ends.iter().filter(|end| is_near(&point(end)));
    let near: f64 = near.map(|end| end.weight).sum();
    (near / ends.weight).max(0.1)
}

/// Position of an end, in cells in the target frame.
fn point(end: &End) -> (f64, f64) {
    let (x, y) = end.from;
    let (dx, dy) = end.towards;
    (x + end.reading * dx, y + end.reading * dy)
}

fn is_near(&(x, y): &(f64, f64)) -> bool {
    x.hypot(y) <= FARTHEST
}
