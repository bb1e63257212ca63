//! Occupancy grid and its id.

use geometry::Pose;
use messages::limits::{origin_is_allowed, resolution_is_allowed, size_is_allowed};

use crate::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M, MapError};

pub use messages::UNKNOWN;

/// A map of square cells.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyGrid {
    /// Width in cells (along x), 1..=[`crate::MAX_SIDE`].
    pub width: u32,
    /// Height in cells (along y), 1..=[`crate::MAX_SIDE`].
    pub height: u32,
    /// Side of a cell in metres.
    pub resolution_m: f64,
    /// Pose of the grid in the map frame: the lower left corner of cell (0, 0), and the rotation of
    /// the grid's axes.
    pub map_from_grid: Pose,
    /// Cells row by row from the lowest y: 0 free to 100 occupied, or [`UNKNOWN`].
    pub cells: Vec<u8>,
}

impl OccupancyGrid {
    /// Creates a grid and checks each part against the crate's limits.
    pub fn from_parts(
        width: u32,
        height: u32,
        resolution_m: f64,
        map_from_grid: Pose,
        cells: Vec<u8>,
    ) -> Result<Self, MapError> {
        let Pose { x, y, yaw } = map_from_grid;
        let found = cells.len();
        let problem = if !size_is_allowed(width, height) {
            format!("a grid of {width} x {height} cells; {}", sizes_allowed())
        } else if !resolution_is_allowed(resolution_m) {
            format!(
                "a resolution of {resolution_m} m; allowed: {MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m"
            )
        } else if !origin_is_allowed(map_from_grid) {
            format!(
                "an origin at x {x} m, y {y} m, yaw {yaw} rad; allowed: within {MAX_ORIGIN_M} m, \
                 and a yaw of at most a turn"
            )
        } else if found as u64 != u64::from(width) * u64::from(height) {
            format!("{found} cells for a grid of {width} x {height}; allowed: width times height")
        } else if let Some(at) = cells.iter().position(|&c| c > 100 && c != UNKNOWN) {
            // Below MAX_CELLS, so both parts fit.
            let (x, y, cell) = (at as u32 % width, at as u32 / width, cells[at]);
            format!("cell {x}, {y} is {cell}; allowed: 0..=100, and 255 for unknown")
        } else {
            return Ok(OccupancyGrid {
                width,
                height,
                resolution_m,
                map_from_grid,
                cells,
            });
        };
        Err(MapError::Invalid(problem))
    }

    /// Returns the id of the map from its geometry and cells: see [`messages::map_id`].
    pub fn id(&self) -> u64 {
        let (sides, origin) = ((self.width, self.height), self.map_from_grid.into());
        messages::map_id(sides, self.resolution_m, origin, &self.cells)
    }

    /// Returns the centre of a cell in the map frame, in metres; cells off the grid are
    /// extrapolated.
    pub fn cell_center(&self, x: u32, y: u32) -> (f64, f64) {
        self.map_from_grid.transform(
            (f64::from(x) + 0.5) * self.resolution_m,
            (f64::from(y) + 0.5) * self.resolution_m,
        )
    }

    /// Returns the column and row of the cell with a point of the map frame, if the point is on the
    /// grid.
    pub fn cell_at(&self, x_m: f64, y_m: f64) -> Option<(u32, u32)> {
        let (x, y) = self.map_from_grid.inverse().transform(x_m, y_m);
        let column = (x / self.resolution_m).floor();
        let row = (y / self.resolution_m).floor();
        let inside = (0.0..f64::from(self.width)).contains(&column)
            && (0.0..f64::from(self.height)).contains(&row);
        inside.then_some((column as u32, row as u32))
    }
}

/// Says which sides [`size_is_allowed`] accepts.
pub(crate) fn sizes_allowed() -> String {
    format!("allowed: sides of 1..={MAX_SIDE} and at most {MAX_CELLS} cells")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use super::*;

    fn grid(cells: &[u8]) -> OccupancyGrid {
        let height = cells.len() as u32 / 3;
        OccupancyGrid::from_parts(3, height, 0.5, Pose::new(10.0, 20.0, 0.0), cells.to_vec())
            .unwrap()
    }

    #[test]
    fn parts_out_of_range_are_refused() {
        let at = Pose::IDENTITY;
        let check = |sides: (u32, u32), resolution, pose, cells: Vec<u8>, expected: &str| {
            let grid = OccupancyGrid::from_parts(sides.0, sides.1, resolution, pose, cells);
            let found = grid.map_or_else(|error| error.to_string(), |_| String::new());
            assert!(found.starts_with(expected), "{found}");
            assert_eq!(found.is_empty(), expected.is_empty(), "{found}");
        };
        check((2, 3), 0.05, at, vec![0; 6], "");
        for sides in [(0, 3), (32_768, 1), (32_767, 32_767)] {
            check(sides, 0.05, at, vec![], "a grid of");
        }
        check((2, 3), 0.05, at, vec![0; 5], "5 cells for a grid of 2 x 3");
        for resolution in [0.0, -0.05, f64::NAN, f64::INFINITY, 0.000_999, 10.001] {
            check((2, 3), resolution, at, vec![0; 6], "a resolution of");
        }
        for (x, y, yaw) in [
            (f64::NAN, 0.0, 0.0),
            (0.0, 1.1e8, 0.0),
            (0.0, 0.0, 7.0),
            (0.0, 0.0, f64::NEG_INFINITY),
        ] {
            let pose = Pose::new(x, y, yaw);
            check((2, 3), 0.05, pose, vec![0; 6], "an origin at");
        }
        let cells = vec![0, 50, 100, UNKNOWN, 101, 0];
        let expected = "cell 1, 1 is 101; allowed: 0..=100, and 255 for unknown";
        check((3, 2), 0.05, at, cells, expected);
    }

    #[test]
    fn equal_maps_have_equal_ids_and_others_do_not() {
        let map = grid(&[0, 0, 100, 0, UNKNOWN, 100]);
        // A constant detects a change of the hash, which must never change.
        assert_eq!(map.id(), 0x3B8F_579C_0E05_75CE);

        let rounded = OccupancyGrid {
            map_from_grid: Pose::new(10.000_000_000_000_002, 20.0, -0.0),
            ..map.clone()
        };
        assert_eq!(rounded.id(), map.id());

        let mut cell = map.clone();
        cell.cells[0] = 1;
        let mut turned = map.clone();
        turned.map_from_grid.yaw = 1e-6;
        let mut finer = map.clone();
        finer.resolution_m = 0.499_999;
        let reshaped = OccupancyGrid {
            width: 2,
            height: 3,
            ..map.clone()
        };
        for other in [cell, turned, finer, reshaped] {
            assert_ne!(other.id(), map.id());
        }
    }

    #[test]
    fn a_turned_grid_puts_its_cells_in_the_map() {
        let mut map = grid(&[0; 6]);
        assert_eq!(map.cell_center(2, 1), (11.25, 20.75));
        map.map_from_grid.yaw = FRAC_PI_2;
        // The grid's x axis now points along the map's y: column 2 is 1.25 m up,
        // row 1 is 0.75 m to the left.
        let (x, y) = map.cell_center(2, 1);
        // The tolerance covers one rotation of numbers near 20.
        assert!((x - 9.25).abs() < 1e-12 && (y - 21.25).abs() < 1e-12);
        assert_eq!(map.cell_at(x, y), Some((2, 1)));
        assert_eq!(map.cell_at(10.1, 20.1), None, "behind the turned grid");
        assert_eq!(map.cell_at(f64::NAN, 0.0), None);
    }

    proptest::proptest! {
        #[test]
        fn every_cell_is_found_at_its_centre(
            x in 0u32..40, y in 0u32..30, yaw in -TAU..TAU,
            ox in -1e4..1e4f64, oy in -1e4..1e4f64, resolution in 0.001..10.0f64,
        ) {
            let map = OccupancyGrid::from_parts(
                40, 30, resolution, Pose::new(ox, oy, yaw), vec![0; 1200],
            ).unwrap();
            let (cx, cy) = map.cell_center(x, y);
            proptest::prop_assert_eq!(map.cell_at(cx, cy), Some((x, y)));
        }
    }
}
