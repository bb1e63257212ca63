//! The reference implementation: every pose, every beam, every cell of every ray.
//!
//! It defines the votes and is far too slow for a real map. The fast accumulators are tested
//! against it and must give the same numbers.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::program::ScanProgram;
use crate::space::Space;

/// Returns the number of steps from a cell to the first occupied cell along a direction; `None` if
/// the ray leaves the map or meets a cell that blocks without being occupied.
#[must_use]
pub fn range(grid: &Grid, x: i64, y: i64, direction: &Direction) -> Option<u16> {
    let (mut x, mut y) = (x, y);
    for steps in 0.. {
        match grid.get(x, y)? {
            Cell::Occupied => return Some(steps),
            Cell::Blocked => return None,
            Cell::Open => (x, y) = direction.advance(x, y),
        }
    }
    None
}

/// Returns the intensity of one pose: the sum of the votes of all beams. 0 where the robot cannot
/// stand.
#[must_use]
pub fn intensity(
    grid: &Grid,
    program: &ScanProgram,
    space: &Space,
    x: i64,
    y: i64,
    heading: usize,
) -> u16 {
    if !grid.is_open(x, y) {
        return 0;
    }
    let votes = (0..program.beams()).map(|beam| {
        let direction = space.directions.get(heading + program.bearing(beam));
        let taper = program.taper(beam, direction.class);
        range(grid, x, y, direction).map_or(0, |steps| u16::from(taper.votes(steps)))
    });
    votes.sum()
}

/// Returns the intensities of all cells at one heading, row by row from the lowest y.
#[must_use]
pub fn field(grid: &Grid, program: &ScanProgram, space: &Space, heading: usize) -> Vec<u16> {
    let (width, height) = (grid.width() as i64, grid.height() as i64);
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    cells
        .map(|(x, y)| intensity(grid, program, space, x, y, heading))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::CellRules;
    use crate::grid::drawn::{grid, grid_with};

    #[test]
    fn ranges_count_steps_to_the_first_occupied_cell() {
        let space = Space::new(8, 1.0, 6, 3).unwrap();
        let grid = grid(&["......", "..##..", "......"]);
        let east = space.directions.get(0);
        assert_eq!(range(&grid, 0, 1, east), Some(2));
        assert_eq!(range(&grid, 2, 1, east), Some(0));
        assert_eq!(range(&grid, 0, 0, east), None, "leaves the map");
        assert_eq!(
            range(&grid, 1, 0, space.directions.get(1)),
            Some(1),
            "north-east"
        );
        assert_eq!(range(&grid, 5, 1, space.directions.get(4)), Some(2), "west");
    }

    #[test]
    fn unknown_cells_swallow_rays_only_where_they_block() {
        let rows = [".?#"];
        let space = Space::new(8, 1.0, 3, 1).unwrap();
        let east = space.directions.get(0);
        assert_eq!(range(&grid(&rows), 0, 0, east), Some(2));
        let rules = CellRules {
            unknown_blocks: true,
            ..CellRules::default()
        };
        assert_eq!(range(&grid_with(&rows, rules), 0, 0, east), None);
    }
}
