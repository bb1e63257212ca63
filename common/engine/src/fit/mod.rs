//! The second stage: the fit of a scan to the map at a pose, by the distances of its end points
//! from obstacles.
//!
//! Votes count along rays, and where a ray grazes a wall, centimetres of wall are half a metre of
//! range. So the places found by the votes are refined continuously and judged again by the
//! perpendicular distance:
//!
//! ```text
//! occupancy ─ distance ─ distance_field ─┬─ refine ─ agreement ─ score, beam classes
//! scan ─ beams ─ ends ───────────────────┘
//! ```
//!
//! Lengths here are in cells and positions in the grid's frame; the centre of cell (0, 0)
//! is (0.5, 0.5).

mod agreement;
mod config;
pub mod distance;
mod distance_field;
mod drawing;
#[cfg(test)]
pub(crate) mod drawn;
mod ends;
mod pull;
mod readings;
mod refine;

use geometry::{Pose, wrap_angle};
use nalgebra::Vector3;

use crate::grid::GridFrame;
pub use config::FitConfig;
pub use distance_field::DistanceField;
pub(crate) use distance_field::lacks;
pub(crate) use ends::End;
pub use ends::{BeamClass, Ends, JudgedBeam};
pub use readings::Readings;
pub use refine::{Expected, Refined};

/// A pose in cells of the grid and radians in its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPose {
    /// Position along the grid's x axis, in cells.
    pub x: f64,
    /// Position along the grid's y axis, in cells.
    pub y: f64,
    /// Heading in radians, counter-clockwise from the grid's x axis.
    pub heading: f64,
}

impl GridPose {
    /// Makes a pose from cells and radians.
    #[must_use]
    pub const fn new(x: f64, y: f64, heading: f64) -> Self {
        GridPose { x, y, heading }
    }

    /// Converts a pose in the map; the inverse of [`GridFrame::map_from_cells`].
    #[must_use]
    pub fn of(frame: GridFrame, map_pose: Pose) -> Self {
        let grid_pose = frame.map_from_grid.inverse().then(map_pose);
        GridPose {
            x: grid_pose.x / frame.resolution_m,
            y: grid_pose.y / frame.resolution_m,
            heading: grid_pose.yaw,
        }
    }

    /// Difference from another pose: cells, cells and radians in `(-π, π]`.
    fn minus(self, other: GridPose) -> Vector3<f64> {
        Vector3::new(
            self.x - other.x,
            self.y - other.y,
            wrap_angle(self.heading - other.heading),
        )
    }
}
