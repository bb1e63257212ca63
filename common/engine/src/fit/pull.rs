//! How far ends of beams lie from obstacles, and how that changes as the pose does.

use super::lanes::{EndLanes, Lanes, lanes};
use super::{DistanceField, GridPose};
use crate::simd::{Kernel, Set};

/// What ends say of a pose.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pulls {
    /// 0 for an end that has no say.
    pub weight: Lanes,
    pub distance: Lanes,
    /// How the distance grows with x, y and the heading.
    pub slope: [Lanes; 3],
}

/// Passes what all ends say of a pose to `add`.
pub(super) struct Pull<'a, A> {
    pub field: &'a DistanceField,
    pub ends: &'a [EndLanes],
    pub pose: GridPose,
    /// Ends farther from obstacles have no say, cells.
    pub reach: f64,
    pub sums: A,
}

/// What becomes of pulls.
pub(super) trait Add {
    fn add(&mut self, pulls: &Pulls);
}

impl<A: Add> Kernel for Pull<'_, A> {
    type Result = A;

    #[inline(always)]
    fn run<S: Set>(mut self, _: S) -> A {
        let (sin, cos) = self.pose.heading.sin_cos();
        let (sin, cos) = (sin as f32, cos as f32);
        let (x, y) = (self.pose.x as f32, self.pose.y as f32);
        let nearness = 1.0 / self.reach as f32;
        for ends in self.ends {
            // From the pose, along the axes of the grid.
            let along = lanes(|i| ends.x[i] * cos - ends.y[i] * sin);
            let up = lanes(|i| ends.x[i] * sin + ends.y[i] * cos);
            let (distance, [slope_x, slope_y]) = self
                .field
                .distances(lanes(|i| x + along[i]), lanes(|i| y + up[i]));
            let weight = lanes(|i| {
                let off = distance[i] * nearness;
                let share = (1.0 - off * off).max(0.0);
                ends.weight[i] * share * share
            });
            // Turning by a radian moves the end by (-up, along).
            let turning = lanes(|i| along[i] * slope_y[i] - up[i] * slope_x[i]);
            self.sums.add(&Pulls {
                weight,
                distance,
                slope: [slope_x, slope_y, turning],
            });
        }
        self.sums
    }
}
