//! Pooling of fine maps to larger cells.
//!
//! The search need not be finer than the accuracy of lasers and maps; its results are refined on
//! the map at full resolution.

use messages::UNKNOWN;

use super::{CellRules, GridFrame, check_cells};
use crate::EngineError;

/// A map whose squares of cells are pooled to one cell each.
#[derive(Debug, Clone, PartialEq)]
pub struct Pooled {
    /// Cell size and pose of the pooled grid in the map.
    pub frame: GridFrame,
    /// Number of cells along x and y.
    pub sides: (usize, usize),
    /// Occupancies, row by row from the lowest y.
    pub occupancy: Vec<u8>,
}

/// Returns the side, in map cells, of the largest square whose side is at most `most_m` metres; at
/// least 1.
#[must_use]
pub fn pooling(resolution_m: f64, most_m: f64) -> usize {
    // Tolerance, since resolutions are often stored in 32 bits.
    const ROUNDING: f64 = 1e-3;
    ((most_m / resolution_m + ROUNDING) as usize).max(1)
}

impl GridFrame {
    /// Returns the frame of the grid whose cells are `pooling` of these along a side.
    #[must_use]
    pub fn pooled(self, pooling: usize) -> Self {
        GridFrame {
            resolution_m: self.resolution_m * pooling as f64,
            ..self
        }
    }
}

impl Pooled {
    /// Pools `pooling · pooling` cells to one: occupied if any of them is, else free if any is,
    /// else unknown.
    ///
    /// # Errors
    /// See [`Grid::new`](super::Grid::new).
    pub fn new(
        frame: GridFrame,
        (width, height): (usize, usize),
        occupancy: &[u8],
        rules: CellRules,
        pooling: usize,
    ) -> Result<Self, EngineError> {
        check_cells(width, height, occupancy)?;
        let sides = (width.div_ceil(pooling), height.div_ceil(pooling));
        let mut pooled = vec![UNKNOWN; sides.0 * sides.1];
        let rank = |value: u8| match () {
            () if value == UNKNOWN => 0,
            () if value >= rules.occupied_from => 3,
            () if value <= rules.free_to => 2,
            () => 1,
        };
        for (y, row) in occupancy.chunks_exact(width).enumerate() {
            let into = &mut pooled[y / pooling * sides.0..][..sides.0];
            for (cells, into) in row.chunks(pooling).zip(into) {
                for &value in cells {
                    if rank(value) > rank(*into) {
                        *into = value;
                    }
                }
            }
        }
        Ok(Pooled {
            frame: frame.pooled(pooling),
            sides,
            occupancy: pooled,
        })
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::super::drawn;
    use super::*;

    const FRAME: GridFrame = GridFrame::new(0.01, Pose::new(1.0, 2.0, 0.5));

    #[test]
    fn squares_are_as_large_as_allowed() {
        let check = |resolution_m, expected| {
            assert_eq!(pooling(resolution_m, 0.05), expected, "{resolution_m}");
        };
        check(0.01, 5);
        check(0.02, 2);
        check(0.026, 1);
        check(0.05, 1);
        check(0.5, 1);
        check(f64::from(0.025f32), 2);
        assert_eq!(pooling(0.01, 0.0), 1);
    }

    #[test]
    fn an_obstacle_fills_its_square_and_free_cells_what_is_unknown() {
        let (width, height, occupancy) = drawn::occupancy(&["#.???", ".....", "???..", "?????"]);
        let rules = CellRules::default();
        let pooled = Pooled::new(FRAME, (width, height), &occupancy, rules, 2).unwrap();
        assert_eq!(pooled.sides, (3, 2));
        assert_eq!(pooled.frame.resolution_m, 0.02);
        assert_eq!(pooled.frame.map_from_grid, FRAME.map_from_grid);
        let (_, _, expected) = drawn::occupancy(&["#..", "?.."]);
        assert_eq!(pooled.occupancy, expected);
    }

    #[test]
    fn cells_that_do_not_fill_the_map_are_refused() {
        let refused = Pooled::new(FRAME, (3, 2), &[0; 5], CellRules::default(), 2);
        assert!(matches!(refused, Err(EngineError::GridCells { .. })));
    }
}
