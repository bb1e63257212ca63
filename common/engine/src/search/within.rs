//! The limits of a search, laid out for blocks of each size.

use super::bits::CHUNK;
use super::block_ids::BlockIds;
use super::intervals::SIDE;
use super::sets::{Quad, RangeSets};
use crate::grid::Grid;
use crate::limits::Limits;

/// Where poses are sought, block by block.
#[derive(Debug, Clone)]
pub(super) struct Within {
    pub limits: Limits,
    /// The blocks of 8 × 8 and of 16 × 16 cells in which poses are sought.
    blocks: [BlockIds; 2],
}

/// A size of blocks that have sets.
#[derive(Debug, Clone, Copy)]
pub(super) enum Size {
    Fine,
    Coarse,
}

impl Within {
    /// Lays out the limits of a grid.
    pub(super) fn new(limits: Limits, grid: &Grid) -> Self {
        let blocks = [2 * SIDE, 4 * SIDE].map(|side| BlockIds::new(&limits.blocks(side, grid)));
        Within { limits, blocks }
    }

    /// Whether poses are sought in a block.
    pub(super) fn holds(&self, size: Size, block: usize) -> bool {
        self.blocks[size as usize].holds(block)
    }

    /// Bytes that they take.
    pub(super) fn bytes(&self) -> usize {
        self.limits.bytes() + self.blocks.iter().map(BlockIds::bytes).sum::<usize>()
    }

    /// A quad of blocks of a size, for those in which poses are sought.
    pub(super) fn quad(&self, size: Size, sets: &RangeSets, quad: usize) -> Quad {
        sets.sought(quad, |block| self.holds(size, block))
    }

    /// The headings that are sought among `count`, a word a chunk.
    pub(super) fn headings(&self, count: usize) -> impl Iterator<Item = u128> {
        (0..count).step_by(CHUNK).map(move |first| {
            let headings = first..count.min(first + CHUNK);
            let sought = headings.filter(|&heading| self.limits.hold_heading(heading));
            sought.fold(0u128, |word, heading| word | 1u128 << (heading - first))
        })
    }
}
