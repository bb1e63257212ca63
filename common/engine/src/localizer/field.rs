//! Counting of votes at a known heading: by sweeps over all cells, or out from the boundary.

use messages::BoundaryCell;

use crate::accumulator::{Accumulator, Query};
use crate::boundary;
use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::scatter::Scatter;
use crate::simd::Simd;
use crate::sweep::{self, FieldSweep};

/// Number of cells that a sweep passes in the time of one projection step. A step misses the cache:
/// some 2.5 ns, against 0.2 to 0.5 ns per cell with AVX2 (`field_time boxes 1200 1 5 --beams 8`).
const CELLS_A_STEP: u64 = 8;

/// A grid prepared for votes at known headings.
#[derive(Debug, Clone)]
pub(super) struct Fields {
    sweeps: FieldSweep,
    boundary: Vec<BoundaryCell>,
}

impl Fields {
    /// Prepares a grid; extracts its boundary unless given.
    pub(super) fn new(grid: &Grid, boundary: Option<Vec<BoundaryCell>>) -> Self {
        Fields {
            sweeps: FieldSweep::new(grid),
            boundary: boundary.unwrap_or_else(|| boundary::extract(grid)),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        self.sweeps.bytes() + size_of_val(&self.boundary[..])
    }

    /// Fills in the intensities of all cells, row by row from the lowest y; `None` if `stop`
    /// returned true before the end.
    pub(super) fn fill(
        &self,
        grid: &Grid,
        query: Query<'_>,
        (workspace, field): (&mut sweep::Workspace, &mut Vec<u16>),
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        if self.scatter_is_cheaper(grid, query) {
            return Scatter::new(grid, &self.boundary).fill(query, field, stop);
        }
        let best = Simd::new(InstructionSet::best());
        self.sweeps.fill(best, query, workspace, field, stop)
    }

    /// True if projections take fewer steps than the sweeps pass cells, even if no obstacle ends a
    /// projection early.
    fn scatter_is_cheaper(&self, grid: &Grid, query: Query<'_>) -> bool {
        let beams = 0..query.program.beams();
        let swept = (grid.cells().len() * beams.len()) as u64;
        let steps = beams.map(|beam| u64::from(query.beam(beam).1.end()));
        let projected = steps.sum::<u64>() * self.boundary.len() as u64;
        projected * CELLS_A_STEP < swept
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::grid::drawn::grid;
    use crate::program::{ScanProgram, VoteConfig};
    use crate::reference;
    use crate::scan::Scan;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn the_cheaper_method_counts_the_same_votes(
            grid in any_grid(), scan in any_scan(), heading in 0usize..72,
        ) {
            let space = &space_of(&grid, 72);
            let query = Query { program: &scan.program(space), space, heading };
            let fields = Fields::new(&grid, None);
            let (mut workspace, mut field) = (sweep::Workspace::default(), Vec::new());
            let filled = fields.fill(&grid, query, (&mut workspace, &mut field), &|| false);
            prop_assert!(filled.is_some());
            prop_assert_eq!(field, reference::field(&grid, query.program, space, heading));
        }
    }

    #[test]
    fn few_obstacles_are_cheaper_to_project_from_than_all_cells_to_sweep() {
        let with_walls = |walls: usize| {
            let row = |y: usize| {
                if y.is_multiple_of(64) && y / 64 < walls {
                    "#"
                } else {
                    "."
                }
            };
            let rows: Vec<String> = (0..512).map(|y| row(y).repeat(512)).collect();
            grid(&rows.iter().map(String::as_str).collect::<Vec<_>>())
        };
        let mut rows = vec![".".repeat(512); 512];
        rows[256].replace_range(256..257, "#");
        let post = grid(&rows.iter().map(String::as_str).collect::<Vec<_>>());
        let ranges = [2.0; 8];
        let scan = Scan {
            angle_min: 0.0,
            angle_increment: 0.7,
            range_min_m: 0.0,
            range_max_m: 10.0,
            ranges: &ranges,
        };
        for (grid, expected) in [(&post, true), (&with_walls(8), false)] {
            let space = &space_of(grid, 72);
            let program = &ScanProgram::new(&scan, 0.0, space, &VoteConfig::default()).unwrap();
            let query = Query {
                program,
                space,
                heading: 3,
            };
            assert_eq!(
                Fields::new(grid, None).scatter_is_cheaper(grid, query),
                expected
            );
        }
    }
}
