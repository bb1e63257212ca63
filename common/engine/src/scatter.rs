//! The paper's method: votes go out from the boundary cells.
//!
//! Each reading is projected from every boundary cell back along its direction (section II A, Eq.
//! 1), as far as cells are open: cells behind an obstacle do not see the boundary cell. At most m
//! votes reach any pose (Lemma 1).

use messages::BoundaryCell;

use crate::accumulator::{Accumulator, Query};
use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::program::Taper;

/// Counts votes from the boundary cells outward; fastest with few beams on maps with few boundary
/// cells.
#[derive(Debug, Clone, Copy)]
pub struct Scatter<'a> {
    grid: &'a Grid,
    boundary: &'a [BoundaryCell],
}

impl<'a> Scatter<'a> {
    /// Takes a map and its boundary from [`crate::boundary::extract`].
    #[must_use]
    pub fn new(grid: &'a Grid, boundary: &'a [BoundaryCell]) -> Self {
        Scatter { grid, boundary }
    }

    fn project(&self, direction: &Direction, taper: Taper<'_>, field: &mut [u16]) {
        let back = direction.opposite();
        for cell in self.boundary {
            let (mut x, mut y) = (i64::from(cell.x), i64::from(cell.y));
            for steps in 1..taper.end() {
                (x, y) = back.advance(x, y);
                if self.grid.get(x, y) != Some(Cell::Open) {
                    break;
                }
                field[y as usize * self.grid.width() + x as usize] += u16::from(taper.votes(steps));
            }
        }
    }
}

impl Accumulator for Scatter<'_> {
    fn fill(
        &mut self,
        query: Query<'_>,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        field.clear();
        field.resize(self.grid.cells().len(), 0);
        for beam in 0..query.program.beams() {
            if stop() {
                return None;
            }
            let (direction, taper) = query.beam(beam);
            self.project(direction, taper, field);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::boundary;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn no_pose_has_more_votes_than_beams(grid in any_grid(), scan in any_scan(), heading in 0usize..72) {
            // Lemma 1, with one vote for each beam that reaches a pose: no beam reaches it from two
            // boundary cells.
            let space = &space_of(&grid, 72);
            let program = &scan.program(space);
            let boundary = boundary::extract(&grid);
            let most: u16 = (0..program.beams()).map(|beam| program.peak(beam)).sum();
            prop_assert_eq!(u32::from(most), program.highest_possible());
            let mut field = Vec::new();
            let query = Query { program, space, heading };
            prop_assert!(Scatter::new(&grid, &boundary).fill(query, &mut field, &|| false).is_some());
            prop_assert!(field.iter().all(|&votes| votes <= most));
        }
    }
}
