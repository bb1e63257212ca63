//! The limits of a search, laid out for blocks of each size.

use super::bits::CHUNK;
use super::intervals::SIDE;
use super::sets::{Quad, RangeSets};
use crate::grid::{CellSet, Grid};
use crate::limits::Limits;

/// Where poses are searched, block by block.
#[derive(Debug, Clone)]
pub(in crate::search) struct Within {
    pub limits: Limits,
    /// The blocks of 8 × 8 and of 16 × 16 cells in which poses are searched.
    pub blocks: [CellSet; 2],
}

/// A size of blocks that have sets.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) enum Size {
    Fine,
    Coarse,
}

impl Within {
    /// Lays out the limits of a grid.
    pub(in crate::search) fn new(limits: Limits, grid: &Grid) -> Self {
        let blocks = [2 * SIDE, 4 * SIDE].map(|side| {
            let blocks = limits.blocks(side, grid);
            CellSet::of(blocks.len(), |block| blocks[block])
        });
        Within { limits, blocks }
    }

    /// Limits and blocks of a grid that are still to be filled in.
    pub(in crate::search) fn unfilled(limits: Limits, grid: &Grid) -> Self {
        let blocks = [2 * SIDE, 4 * SIDE].map(|side| {
            let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
            CellSet::none(columns * rows)
        });
        Within { limits, blocks }
    }

    /// Whether poses are searched in a block.
    pub(in crate::search) fn holds(&self, size: Size, block: usize) -> bool {
        self.blocks[size as usize].holds(block)
    }

    /// Bytes that they take.
    pub(in crate::search) fn bytes(&self) -> usize {
        self.limits.bytes() + self.blocks.iter().map(CellSet::bytes).sum::<usize>()
    }

    /// A quad of blocks of a size, for those in which poses are searched.
    pub(in crate::search) fn quad(&self, size: Size, sets: &RangeSets, quad: usize) -> Quad {
        sets.searched(quad, |block| self.holds(size, block))
    }

    /// The headings that are searched among `count`, a word a chunk.
    pub(in crate::search) fn headings(&self, count: usize) -> impl Iterator<Item = u128> {
        (0..count).step_by(CHUNK).map(move |first| {
            let headings = first..count.min(first + CHUNK);
            let searched = headings.filter(|&heading| self.limits.hold_heading(heading));
            searched.fold(0u128, |word, heading| word | 1u128 << (heading - first))
        })
    }
}

/// The blocks of the next smaller size in a block, as far as they are on the
/// map.
pub(in crate::search) fn quarters(
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
