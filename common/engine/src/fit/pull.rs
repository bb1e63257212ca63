//! Distances of beam ends from obstacles, and their derivatives by the pose, for groups of eight
//! ends. Numbers have 32 bits, which is 1/256 of a cell on the largest map; sums are per lane, so
//! that every instruction set gives the same ones.

use super::GridPose;
use super::distance_field::{DistanceField, Lanes, lanes};
use crate::simd::{Kernel, Set};

/// Ends of beams in the target frame, in cells; unused lanes have weight 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct EndLanes {
    pub x: Lanes,
    pub y: Lanes,
    pub weight: Lanes,
}

/// Distances of eight ends at a pose, and their derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pulls {
    /// Weight; 0 for an end that does not count.
    pub weight: Lanes,
    pub distance: Lanes,
    /// Derivatives of the distance by x, y and the heading.
    pub slope: [Lanes; 3],
}

/// Kernel that passes the pulls of all ends at a pose to `add`.
pub(super) struct Pull<'a, A> {
    pub field: &'a DistanceField,
    pub ends: &'a [EndLanes],
    pub pose: GridPose,
    /// Largest distance from obstacles of ends that count, in cells.
    pub reach: f64,
    pub sums: A,
}

/// Consumer of pulls.
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
            // Offsets from the pose, along the axes of the grid.
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
