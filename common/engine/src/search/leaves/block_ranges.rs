//! Exact ranges of the cells of a small block, computed for a direction when they are
//! first needed.
//!
//! The block's intervals say how near the first obstacle can be, so rays are followed only
//! from there, all rays that leave the block in a direction at once. Cells in line share a
//! ray.

use super::bundle::{self, Bundle};
use crate::directions::Directions;
use crate::grid::{Cell, Grid};
use crate::limits::Limits;
use crate::program::NO_RANGE;
use crate::search::index::bins::Bins;
use crate::search::index::intervals::{BlockIntervals, CELLS, RangeIntervals, SIDE};
use crate::search::index::obstacles::Obstacles;

/// A map and the tables for following rays in it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    pub grid: &'a Grid,
    pub obstacles: &'a Obstacles,
    pub bins: &'a Bins,
    pub directions: &'a Directions,
}

/// The ranges of the cells of one block.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockRanges {
    by_direction: Vec<[u16; CELLS]>,
    /// Number of the block for which each direction was computed last.
    computed_for: Vec<u32>,
    /// Number of the current block.
    number: u32,
    left: usize,
    bottom: usize,
    cells: [Cell; CELLS],
    /// True if all of the block's cells are open.
    all_open: bool,
    /// All ones for each cell in which poses are searched, else 0.
    pub open: [u16; CELLS],
    pub intervals: BlockIntervals,
    /// True if unknown cells block rays. Then rays must be followed from the start, because
    /// intervals say only where they hit an obstacle.
    has_blocked: bool,
    /// Number of times that rays were cast in a direction of any block, until they are taken.
    pub casts: u64,
}

impl BlockRanges {
    /// Starts with a map. Earlier ranges are dropped with the next block, because its number is
    /// new.
    pub(crate) fn prepare(&mut self, grid: &Grid, directions: &Directions) {
        let count = directions.count();
        self.by_direction.resize(count, [NO_RANGE; CELLS]);
        self.computed_for.resize(count, 0);
        self.has_blocked = grid.has_blocked();
        self.casts = 0;
    }

    /// Starts with a block.
    pub(crate) fn enter(
        &mut self,
        (view, limits): (&View<'_>, &Limits),
        intervals: &RangeIntervals,
        block: usize,
    ) {
        if self.number == u32::MAX {
            self.computed_for.fill(0);
            self.number = 0;
        }
        self.number += 1;
        intervals.read(block, &mut self.intervals);
        self.left = block % intervals.columns * SIDE;
        self.bottom = block / intervals.columns * SIDE;
        self.all_open = view.obstacles.are_none_in((self.left, self.bottom));
        if self.all_open {
            self.cells = [Cell::Open; CELLS];
        } else {
            self.cells = std::array::from_fn(|i| {
                let (x, y) = self.cell(i);
                view.grid.get(x as i64, y as i64).unwrap_or(Cell::Blocked)
            });
        }
        self.open = std::array::from_fn(|i| {
            let (x, y) = self.cell(i);
            let is_searched = self.cells[i] == Cell::Open && limits.hold_cell(x, y);
            if is_searched { u16::MAX } else { 0 }
        });
    }

    /// Returns column and row of the block's cell `i`.
    pub(crate) fn cell(&self, i: usize) -> (usize, usize) {
        (self.left + i % SIDE, self.bottom + i / SIDE)
    }

    /// Computes the ranges in direction `d`, unless that was done for this block.
    #[inline(always)]
    pub(crate) fn compute(&mut self, view: &View<'_>, d: usize) {
        if self.computed_for[d] != self.number {
            self.computed_for[d] = self.number;
            self.casts += 1;
            self.cast_rays(view, d);
        }
    }

    /// Returns the ranges in direction `d`, in steps; they must have been computed.
    #[inline(always)]
    pub(crate) fn ranges(&self, d: usize) -> &[u16; CELLS] {
        &self.by_direction[d]
    }

    /// Returns the two spans of steps at which rays in direction `d` may end, their ends
    /// exclusive.
    #[inline(always)]
    pub(crate) fn spans(&self, view: &View<'_>, d: usize) -> [(u16, u16); 2] {
        let class = view.directions.all()[d].class;
        let [near_first, near_last, far_first, far_last] = &self.intervals.rows;
        let span = |first: u8, last: u8| view.bins.span(class, first, last);
        [
            span(near_first[d], near_last[d]),
            span(far_first[d], far_last[d]),
        ]
    }

    #[inline(always)]
    fn cast_rays(&mut self, view: &View<'_>, d: usize) {
        let direction = &view.directions.all()[d];
        let [near, far] = self.spans(view, d);
        let spans = if self.has_blocked {
            [(1, near.1.max(far.1)), (0, 0)]
        } else {
            [near, far]
        };
        let bundle = Bundle::new(direction, (self.left, self.bottom));
        let rays = view.obstacles.rays(direction, bundle.start);
        let mut hits = bundle.follow(&rays, spans);
        if self.has_blocked {
            bundle::drop_blocked(&rays, view.grid, &mut hits);
        }
        self.by_direction[d] = if self.all_open {
            bundle.ranges(&hits)
        } else {
            bundle.ranges_among(hits, &self.cells)
        };
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::reference;
    use crate::testing::{any_grid, any_long_grid, space_of};

    proptest! {
        #[test]
        fn ranges_equal_those_of_stepping_along_each_ray(
            grid in prop_oneof![3 => any_grid(), 1 => any_long_grid()], headings in 1u32..10,
        ) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(&grid, directions);
            let (intervals, _) = RangeIntervals::of_all(&grid, directions, &bins, InstructionSet::best());
            let obstacles = Obstacles::new(&grid);
            let view = View { grid: &grid, obstacles: &obstacles, bins: &bins, directions };
            let mut block_ranges = BlockRanges::default();
            block_ranges.prepare(&grid, directions);
            let blocks = 0..intervals.columns * intervals.rows;
            for block in blocks {
                block_ranges.enter((&view, &Limits::none(grid.width())), &intervals, block);
                let open = block_ranges.open;
                for (d, direction) in directions.all().iter().enumerate() {
                    block_ranges.compute(&view, d);
                    for (i, &open) in open.iter().enumerate() {
                        let (x, y) = block_ranges.cell(i);
                        let (x, y) = (x as i64, y as i64);
                        prop_assert_eq!(open != 0, grid.is_open(x, y));
                        if grid.is_open(x, y) {
                            let plain = reference::range(&grid, x, y, direction).unwrap_or(NO_RANGE);
                            prop_assert_eq!(block_ranges.ranges(d)[i], plain, "{:?} {:?}", (x, y), direction);
                        }
                    }
                }
            }
        }
    }
}
