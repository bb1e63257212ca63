//! How the robot moved without odometry: each scan is matched to one before, which
//! stays the same until the robot is some way off, so that errors do not add up from
//! scan to scan (Lu and Milios, "Robot pose estimation in unknown environments by
//! matching 2D range scans", J. Intelligent and Robotic Systems 18, 1997).

use geometry::Pose;
use nalgebra::Matrix3;

use super::TrackingConfig;
use super::driven_path::DrivenPath;
use super::seen::Seen;
use crate::EngineError;
use crate::fit::{DistanceField, End, Ends, FitConfig};
use crate::grid::{CellRules, GridFrame};

/// A match with a lower score says nothing: two fifths of the beams see what the scan
/// before did not, or the robot was carried away.
const MIN_SCORE: f64 = 0.6;

/// A match with a lower score is tried again from other headings.
const SURE_SCORE: f64 = 0.8;

/// Ends of beams farther off are left out, cells: beams lie too far apart there, and a map
/// as wide takes some milliseconds to prepare.
const FARTHEST: f64 = 400.0;

/// Matches scans to one before.
#[derive(Debug, Clone, Default)]
pub struct ScanMatcher {
    /// The scan that others are matched to, as a map in whose origin it was taken.
    reference: Option<DistanceField>,
    /// From there to the last scan.
    gone: Pose,
    /// How the robot moved to the last scan: it continues as it went.
    step: Pose,
}

impl ScanMatcher {
    /// How the target frame moved since the scan before: as odometry says, or where that
    /// says nothing, as the two match; `None` where they do not, or there was none.
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

    /// How the target frame moved since the scan before, as the two match; `None` where
    /// they do not, or there was none. The ends are in cells of this many metres.
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
        // The others end off the map.
        let near = near_share(ends);
        let mut fitted = before.settle(predicted);
        if fitted.score < SURE_SCORE * near {
            fitted = before.settle_turned(predicted, fitted);
        }
        let step = self.gone.inverse().then(fitted.pose);
        (fitted.score >= MIN_SCORE * near).then_some(step)
    }
}

/// The ends of a scan as a map, with cells of this many metres.
fn around(ends: &Ends, resolution_m: f64) -> Result<DistanceField, EngineError> {
    let ends = || near_ends(ends);
    let reach = ends().fold(1.0, |reach: f64, (x, y)| reach.max(x.abs()).max(y.abs()));
    let half = reach as usize + 2;
    let side = 2 * half;
    let mut occupancy = vec![0; side * side];
    for (x, y) in ends() {
        let cell = |along: f64| (along + half as f64) as usize;
        occupancy[cell(y) * side + cell(x)] = 100;
    }
    let corner = -(half as f64) * resolution_m;
    let frame = GridFrame {
        resolution_m,
        map_from_grid: Pose::new(corner, corner, 0.0),
    };
    DistanceField::new(frame, (side, side), &occupancy, CellRules::default())
}

/// Where beams end that end near, in cells about the target frame.
fn near_ends(ends: &Ends) -> impl Iterator<Item = (f64, f64)> {
    ends.ends.iter().map(point).filter(is_near)
}

/// Their share of the weights of all, 0.1 at least: a match by a tenth of the beams is not
/// taken for one by all.
fn near_share(ends: &Ends) -> f64 {
    let near = ends.ends.iter().filter(|end| is_near(&point(end)));
    let near: f64 = near.map(|end| end.weight).sum();
    (near / ends.weight).max(0.1)
}

fn point(end: &End) -> (f64, f64) {
    let (x, y) = end.from;
    let (dx, dy) = end.towards;
    (x + end.reading * dx, y + end.reading * dy)
}

fn is_near(&(x, y): &(f64, f64)) -> bool {
    x.hypot(y) <= FARTHEST
}
