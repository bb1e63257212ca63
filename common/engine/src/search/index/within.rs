//! The limits of a search, laid out for blocks of each size.

use super::bits::CHUNK;
use super::intervals::SIDE;
use super::sets::{Quad, RangeSets};
use crate::grid::{CellSet, Grid};
use crate::limits::Limits;

/// Limits of a search, and the blocks in which poses are searched.
#[derive(Debug, Clone)]
pub(crate) struct Within {
    pub limits: Limits,
    /// Blocks of 8 × 8 and of 16 × 16 cells in which poses are searched.
    pub blocks: [CellSet; 2],
}

/// Size of blocks that have sets.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Size {
    Fine,
    Coarse,
}

impl Within {
    /// Lays out the limits of a grid.
    pub(crate) fn new(limits: Limits, grid: &Grid) -> Self {
        let blocks = [2 * SIDE, 4 * SIDE].map(|side| limits.blocks(side, grid));
        Within { limits, blocks }
    }

    /// Allocates the blocks of a grid, to be filled in along with the limits.
    pub(crate) fn unfilled(limits: Limits, grid: &Grid) -> Self {
        let blocks = [2 * SIDE, 4 * SIDE].map(|side| {
            let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
            CellSet::none(columns * rows)
        });
        Within { limits, blocks }
    }

    /// True if poses are searched in a block.
    pub(crate) fn holds(&self, size: Size, block: usize) -> bool {
        self.blocks[size as usize].holds(block)
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.limits.bytes() + self.blocks.iter().map(CellSet::bytes).sum::<usize>()
    }

    /// Returns a quad of blocks of a size, with those in which poses are searched.
    pub(crate) fn quad(&self, size: Size, sets: &RangeSets, quad: usize) -> Quad {
        sets.searched(quad, |block| self.holds(size, block))
    }

    /// Returns a bit for each heading below `count` that is searched, a word for each chunk.
    pub(crate) fn headings(&self, count: usize) -> impl Iterator<Item = u128> {
        (0..count).step_by(CHUNK).map(move |first| {
            let headings = first..count.min(first + CHUNK);
            let searched = headings.filter(|&heading| self.limits.hold_heading(heading));
            searched.fold(0u128, |word, heading| word | 1u128 << (heading - first))
        })
    }
}

/// Returns the blocks of the next smaller size in a block, as far as they are on the map.
pub(crate) fn quarters(
    index: usize,
    columns: usize,
    (finer_columns, finer_rows): (usize, usize),
) -> impl Iterator<Item = usize> + Clone {
    let (x, y) = (2 * (index % columns), 2 * (index / columns));
    let all = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
    let on_map = move |&(x, y): &(usize, usize)| x < finer_columns && y < finer_rows;
    all.into_iter()
        .filter(on_map)
        .map(move |(x, y)| y * finer_columns + x)
}
