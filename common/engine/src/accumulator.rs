//! Common interface of all ways to count votes at a known heading, those of this crate and others.

use crate::directions::Direction;
use crate::program::{ScanProgram, Taper};
use crate::space::Space;

/// One scan at one heading.
#[derive(Debug, Clone, Copy)]
pub struct Query<'a> {
    /// Scan, compiled for `space`.
    pub program: &'a ScanProgram,
    /// Space for which the scan was compiled.
    pub space: &'a Space,
    /// Heading as an index on the heading grid.
    pub heading: usize,
}

impl<'a> Query<'a> {
    /// Returns the direction of a beam, and its votes along rays.
    #[must_use]
    pub fn beam(&self, beam: usize) -> (&'a Direction, Taper<'a>) {
        let bearing = self.program.bearing(beam);
        let direction = self.space.directions.get(self.heading + bearing);
        (direction, self.program.taper(beam, direction.class))
    }
}

/// A method of counting votes; it may reuse buffers from scan to scan.
pub trait Accumulator {
    /// Fills in the intensities of all cells, row by row from the lowest y; `None` if `stop`
    /// returned true before the end.
    fn fill(
        &mut self,
        query: Query<'_>,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()>;
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::grid::Grid;
    use crate::instruction_set::InstructionSet;
    use crate::reference;
    use crate::sweep::FieldSweep;
    use crate::testing::{any_grid, any_long_grid, any_scan, space_of};

    fn check(grid: &Grid, query: Query<'_>) -> Result<(), TestCaseError> {
        let plain = reference::field(grid, query.program, query.space, query.heading);
        let sweeps = FieldSweep::new(grid);
        for set in InstructionSet::available() {
            let mut accumulator = sweeps.accumulator_with(set);
            // The content left by another scan must not matter.
            let mut field = vec![7; 5];
            for _ in 0..2 {
                prop_assert!(accumulator.fill(query, &mut field, &|| false).is_some());
                prop_assert_eq!(&field, &plain, "{}", set);
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn all_accumulators_equal_the_reference(
            grid in any_grid(), scan in any_scan(), headings in 1u32..12, heading in 0usize..96,
        ) {
            let space = &space_of(&grid, headings * 8);
            check(&grid, Query { program: &scan.program(space), space, heading })?;
        }

        #[test]
        fn readings_beyond_a_byte_of_steps_count_as_well(
            grid in any_long_grid(), scan in any_scan(), heading in 0usize..16,
        ) {
            let space = &space_of(&grid, 16);
            check(&grid, Query { program: &scan.stretched(18.0).program(space), space, heading })?;
        }
    }
}
