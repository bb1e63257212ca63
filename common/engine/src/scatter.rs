//! The paper's method: votes go out from the boundary cells.
//!
//! Each reading is projected from every boundary cell back along its direction
//! (section II A, Eq. 1), as far as cells are open: what lies behind an
//! obstacle does not see the boundary cell. At most m votes reach any pose
//! (Lemma 1).

use messages::BoundaryCell;

use crate::grid::{Cell, Grid};
use crate::program::ScanProgram;
use crate::space::Space;

/// Intensities of all cells at one heading, row by row from the lowest y.
#[must_use]
pub fn field(
    grid: &Grid,
    boundary: &[BoundaryCell],
    program: &ScanProgram,
    space: &Space,
    heading: usize,
) -> Vec<u16> {
    let mut field = vec![0; grid.cells().len()];
    for beam in 0..program.beams() {
        let direction = space.directions.get(heading + program.bearing(beam));
        let (taper, back) = (program.taper(beam, direction.class), direction.opposite());
        for cell in boundary {
            let (mut x, mut y) = (i64::from(cell.x), i64::from(cell.y));
            for steps in 1..taper.end() {
                (x, y) = back.advance(x, y);
                if grid.get(x, y) != Some(Cell::Open) {
                    break;
                }
                field[y as usize * grid.width() + x as usize] += u16::from(taper.votes(steps));
            }
        }
    }
    field
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::sweep::{self, SweepGrid};
    use crate::testing::{any_grid, any_scan, space_of};
    use crate::{boundary, reference};

    proptest! {
        #[test]
        fn scatter_and_sweep_equal_the_reference(
            grid in any_grid(), scan in any_scan(), headings in 1u32..12, heading in 0usize..96,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let plain = reference::field(&grid, &program, &space, heading);
            let scattered = field(&grid, &boundary::extract(&grid), &program, &space, heading);
            prop_assert_eq!(&scattered, &plain);
            let sweeps = SweepGrid::new(&grid);
            let swept = sweep::field(&sweeps, &grid, &program, &space, heading, &|| false);
            prop_assert_eq!(swept, Some(plain));
        }

        #[test]
        fn no_pose_has_more_votes_than_beams(grid in any_grid(), scan in any_scan(), heading in 0usize..72) {
            // Lemma 1, with one vote for each beam that reaches a pose: no beam
            // reaches it from two boundary cells.
            let space = space_of(&grid, 72);
            let program = scan.program(&space);
            let boundary = boundary::extract(&grid);
            let most: u16 = (0..program.beams())
                .map(|beam| program.taper(beam, 0).profile.first().map_or(0, |&peak| u16::from(peak)))
                .sum();
            prop_assert_eq!(u32::from(most), program.highest_possible());
            let field = field(&grid, &boundary, &program, &space, heading);
            prop_assert!(field.iter().all(|&votes| votes <= most));
        }
    }
}
