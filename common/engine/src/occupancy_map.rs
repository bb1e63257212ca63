//! An occupancy map as it is given to the engine.

use geometry::Pose;

use crate::grid::{CellRules, GridFrame};

/// A borrowed occupancy map.
#[derive(Debug, Clone, Copy)]
pub struct Map<'a> {
    /// Cell size and pose of the grid in the map frame.
    pub frame: GridFrame,
    /// Number of cells along x and y.
    pub sides: (usize, usize),
    /// Occupancies in per cent, or [`messages::UNKNOWN`], row by row from the lowest y.
    pub occupancy: &'a [u8],
    /// Thresholds for occupied, free and unknown cells.
    pub rules: CellRules,
}

impl<'a> Map<'a> {
    /// Takes a map with cells of this size, of which the first has its lower left corner at a pose in
    /// the map frame, and the default thresholds of ROS.
    #[must_use]
    pub fn new(
        resolution_m: f64,
        map_from_grid: Pose,
        sides: (usize, usize),
        occupancy: &'a [u8],
    ) -> Self {
        Map {
            frame: GridFrame::new(resolution_m, map_from_grid),
            sides,
            occupancy,
            rules: CellRules::default(),
        }
    }
}
