//! Upper bounds of the votes, block by block: roughly where the robot may be.

use super::Workspace;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;
use crate::search::index::SearchIndex;
use crate::simd::Simd;
use crate::space::Space;

/// Upper bounds of the intensities in square blocks, row by row from the
/// lowest y.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct BlockBounds {
    /// Cells along the side of a block.
    pub side: usize,
    /// Blocks along x.
    pub columns: usize,
    /// Votes that no pose in the block exceeds, at any heading.
    pub bounds: Vec<u16>,
}

impl BlockBounds {
    /// Blocks along y.
    pub fn rows(&self) -> usize {
        self.bounds.len() / self.columns
    }
}

impl SearchIndex {
    /// Fills in upper bounds of the intensities in all coarse blocks, in a workspace that may have
    /// served other scans and maps.
    pub fn block_bounds_in(
        &self,
        workspace: &mut Workspace,
        (program, space): (&ScanProgram, &Space),
        blocks: &mut BlockBounds,
    ) {
        let (coarse, directions) = (&self.coarse, &space.directions);
        let best = Simd::new(InstructionSet::best());
        let set_program = &mut workspace.shared.sets;
        let bounds = &mut workspace.alternatives.bounds;
        set_program.make(program, directions, &self.bins, best);
        bounds.fit(set_program, self.headings(directions.count()));
        blocks.side = coarse.side;
        blocks.columns = coarse.columns;
        blocks.bounds.clear();
        blocks.bounds.resize(coarse.blocks(), 0);
        let quads = (0..coarse.quads()).map(|quad| coarse.searched_quad(quad));
        set_program.bound_all(coarse, quads, bounds, |quad, found| {
            for (place, block) in quad.blocks() {
                blocks.bounds[block] = found.greatest(place);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn no_pose_has_more_votes_than_the_bound_of_its_block(
            grid in any_grid(), scan in any_scan(), headings in 1u32..8, heading in 0usize..64,
        ) {
            let space = space_of(&grid, headings * 8);
            let program = scan.program(&space);
            let (mut workspace, mut blocks) = (Workspace::default(), BlockBounds::default());
            SearchIndex::new(&grid, &space).block_bounds_in(&mut workspace, (&program, &space), &mut blocks);
            prop_assert_eq!(blocks.rows(), grid.height().div_ceil(blocks.side));
            let field = reference::field(&grid, &program, &space, heading % space.directions.count());
            for (i, &votes) in field.iter().enumerate() {
                let (x, y) = (i % grid.width(), i / grid.width());
                prop_assert!(votes <= blocks.bounds[y / blocks.side * blocks.columns + x / blocks.side]);
            }
        }
    }
}
