//! The blocks of a grid in which poses are searched, numbered without gaps.
//!
//! Data is kept of these blocks alone, so its size grows with the area where a robot can be
//! and not with the rectangle of the map.

use crate::grid::{CellSet, WORD};
use crate::simd::words::QUAD;

/// A set of blocks of a grid, by their places in it, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BlockIds {
    pub blocks: CellSet,
    /// Number of blocks before each word of the set, and at the end their total.
    before: Vec<u32>,
}

impl BlockIds {
    pub(crate) fn of(blocks: CellSet) -> Self {
        let mut ids = BlockIds {
            blocks,
            before: Vec::new(),
        };
        ids.number();
        ids
    }

    /// Numbers the blocks of the set, which may have been filled in again.
    pub(crate) fn number(&mut self) {
        let mut count = 0;
        self.before.clear();
        self.before.push(0);
        self.before.extend(self.blocks.words().iter().map(|word| {
            count += word.count_ones();
            count
        }));
    }

    /// Number of blocks in the set.
    pub(crate) fn count(&self) -> usize {
        self.before.last().map_or(0, |&count| count as usize)
    }

    #[inline(always)]
    pub(crate) fn holds(&self, block: usize) -> bool {
        self.blocks.holds(block)
    }

    /// Returns the number of the set's blocks before a block, which is that block's number if
    /// it is in the set.
    #[inline(always)]
    pub(crate) fn before(&self, block: usize) -> usize {
        let (word, bit) = (block / WORD, block % WORD);
        let words = self.blocks.words();
        let lower = words.get(word).map_or(0, |word| word & ((1 << bit) - 1));
        (self.before[word] + lower.count_ones()) as usize
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.blocks.bytes() + size_of_val(&self.before[..])
    }
}

/// Returns the two by two blocks of a quad, or of a block of twice the side, as far as they are
/// on a map of this many columns and rows of blocks.
pub(crate) fn quad_of(quad: usize, (columns, rows): (usize, usize)) -> [Option<usize>; QUAD] {
    let quads = columns.div_ceil(2);
    let (left, bottom) = (2 * (quad % quads), 2 * (quad / quads));
    std::array::from_fn(|place| {
        let (x, y) = (left + place % 2, bottom + place / 2);
        (x < columns && y < rows).then(|| y * columns + x)
    })
}
