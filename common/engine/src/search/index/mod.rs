//! A map prepared for searches: the ranges seen from all blocks in which poses are
//! searched.
//!
//! It is made once for each map and then only read. What it says of a block holds for all
//! its cells: no range that a cell sees is missing. Nothing here depends on a scan, a floor
//! or the order in which blocks are searched.

pub(crate) mod bins;
pub(crate) mod bits;
pub(crate) mod block_ids;
pub(crate) mod intervals;
mod key;
mod needed;
pub(crate) mod obstacles;
mod sections;
pub(crate) mod sets;

pub use key::IndexKey;
pub use sections::{SECTIONS, SectionError, UncheckedIndex};

use std::sync::OnceLock;

use bins::Bins;
use bits::CHUNK;
use block_ids::BlockIds;
use intervals::{RangeIntervals, SIDE};
use obstacles::Obstacles;
use sets::RangeSets;

use crate::grid::Grid;
use crate::instruction_set::InstructionSet;
use crate::limits::Limits;
use crate::simd::Simd;
use crate::space::Space;
use crate::sweep::FieldSweep;

/// A map prepared for searches: made once for each map.
#[derive(Debug, Clone)]
pub struct SearchIndex {
    pub(crate) bins: Bins,
    pub(crate) intervals: RangeIntervals,
    pub(crate) fine: RangeSets,
    pub(crate) coarse: RangeSets,
    pub(crate) obstacles: Obstacles,
    pub(crate) limits: Limits,
    /// Prepared for counting every pose; made when bounds first do not help.
    sweeps: OnceLock<FieldSweep>,
}

impl SearchIndex {
    /// Prepares a map for searching poses in all open cells.
    #[must_use]
    pub fn new(grid: &Grid, space: &Space) -> Self {
        Self::within(grid, space, Limits::none(grid.width()))
    }

    /// Prepares a map for searching poses within limits, which must be those of its grid. Data
    /// is kept only of blocks that hold such a pose.
    #[must_use]
    pub fn within(grid: &Grid, space: &Space, limits: Limits) -> Self {
        let directions = &space.directions;
        let bins = Bins::new(grid, directions);
        let blocks = BlockIds::of(limits.blocks(SIDE, grid));
        let best = Simd::new(InstructionSet::best());
        let (intervals, wide) = RangeIntervals::new(grid, directions, &bins, blocks, best);
        let fine = RangeSets::new(&intervals, &wide);
        drop(wide);
        let coarse = fine.joined();
        SearchIndex {
            bins,
            intervals,
            fine,
            coarse,
            obstacles: Obstacles::new(grid),
            limits,
            sweeps: OnceLock::new(),
        }
    }

    /// Returns the limits within which poses are searched.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Returns a bit for each heading below `count` that is searched, a word for each chunk.
    pub(crate) fn headings(&self, count: usize) -> impl Iterator<Item = u128> {
        (0..count).step_by(CHUNK).map(move |first| {
            let headings = first..count.min(first + CHUNK);
            let searched = headings.filter(|&heading| self.limits.hold_heading(heading));
            searched.fold(0, |word, heading| word | 1 << (heading - first))
        })
    }

    /// Number of blocks of 8 × 8 cells in which poses are searched, by their quarters.
    pub(crate) fn blocks(&self) -> usize {
        self.intervals.ids.count().div_ceil(4)
    }

    /// Returns the grid of the index, prepared for counting every pose.
    pub(crate) fn sweeps(&self, grid: &Grid) -> &FieldSweep {
        self.sweeps.get_or_init(|| FieldSweep::new(grid))
    }

    /// Size of the index in bytes.
    pub fn bytes(&self) -> usize {
        let blocks = self.intervals.bytes() + self.fine.bytes() + self.coarse.bytes();
        let sweeps = self.sweeps.get().map_or(0, FieldSweep::bytes);
        blocks + self.limits.bytes() + self.obstacles.bytes() + sweeps
    }
}
