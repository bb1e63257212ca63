//! The limits of a search, laid out for blocks of each size.

use super::bits::CHUNK;
use super::intervals::SIDE;
use super::sets::{Quad, RangeSets};
use crate::limits::Limits;

/// Where poses are sought, block by block.
#[derive(Debug, Clone)]
pub(super) struct Within {
    pub limits: Limits,
    /// For blocks of 4 × 4, 8 × 8 and 16 × 16 cells whether poses are sought in
    /// them; `None` where they are in all.
    blocks: Option<[Vec<bool>; 3]>,
}

/// A size of blocks.
#[derive(Debug, Clone, Copy)]
pub(super) enum Size {
    Small,
    Fine,
    Coarse,
}

impl Within {
    pub(super) fn new(limits: Limits) -> Self {
        let [small, fine, coarse] = [SIDE, 2 * SIDE, 4 * SIDE].map(|side| limits.blocks(side));
        let blocks = small.zip(fine).zip(coarse);
        Within {
            limits,
            blocks: blocks.map(|((small, fine), coarse)| [small, fine, coarse]),
        }
    }

    /// Whether poses are sought in a block.
    pub(super) fn holds(&self, size: Size, block: usize) -> bool {
        let blocks = self.blocks.as_ref();
        blocks.is_none_or(|blocks| blocks[size as usize][block])
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
