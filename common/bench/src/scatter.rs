//! The paper's method as written: votes go out from the boundary cells.
//!
//! Each reading is projected from every boundary cell back along its direction (section II A, Eq.
//! 1), as far as cells are open: cells behind an obstacle do not see the boundary cell. At most m
//! votes reach any pose (Lemma 1).

use engine::accumulator::{Accumulator, Query};
use engine::directions::Direction;
use engine::grid::{Cell, Grid};
use engine::program::{ScanProgram, Taper};
use engine::space::Space;
use messages::BoundaryCell;

/// Counts votes from the boundary cells outward.
#[derive(Debug, Clone, Copy)]
pub struct Scatter<'a> {
    grid: &'a Grid,
    boundary: &'a [BoundaryCell],
}

impl<'a> Scatter<'a> {
    /// Projects from cells of [`engine::boundary::extract`], all or some.
    pub fn new(grid: &'a Grid, boundary: &'a [BoundaryCell]) -> Self {
        Scatter { grid, boundary }
    }

    /// Votes of each cell at a heading, row by row from the lowest y.
    pub fn field(&self, program: &ScanProgram, space: &Space, heading: usize) -> Vec<u16> {
        let query = Query {
            program,
            space,
            heading,
        };
        let (mut scatter, mut field) = (*self, Vec::new());
        // Nothing stops it, so it fills the field.
        let _ = scatter.fill(query, &mut field, &|| false);
        field
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
    use engine::reference;
    use engine::taper::TaperShape;

    use super::*;
    use crate::scans::{ScanConfig, simulate};
    use crate::worlds::{Kind, World};

    #[test]
    fn votes_equal_the_reference_and_none_has_more_than_its_beams() {
        let config = ScanConfig::new(24, 5.0);
        for (kind, shape) in [
            (Kind::Rooms, TaperShape::Trapezoid),
            (Kind::Boxes, TaperShape::Gaussian),
        ] {
            let world = World::generate(kind, (90, 70), 0.5, 3).unwrap();
            let space = &world.space(72).unwrap();
            for scan in simulate(&world, space, &config, 3, 5).unwrap() {
                let program =
                    &ScanProgram::new(&scan.scan(), 0.0, space, &config.votes(shape)).unwrap();
                // Lemma 1: no beam reaches a pose from two boundary cells.
                let most = program.highest_possible();
                let mut scatter = Scatter::new(&world.grid, &world.boundary);
                let mut field = vec![7; 5];
                for heading in [0, 31, scan.heading] {
                    let query = Query {
                        program,
                        space,
                        heading,
                    };
                    assert!(scatter.fill(query, &mut field, &|| false).is_some());
                    let plain = reference::field(&world.grid, program, space, heading);
                    assert_eq!(field, plain);
                    assert!(field.iter().all(|&votes| u32::from(votes) <= most));
                }
            }
        }
    }
}
