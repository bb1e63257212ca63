//! What the blocks of a quad are bounded by at each heading: numbers as planes.

use super::set_program::GROUPS;
use crate::search::index::bits::{self, Planes};
use crate::simd::words::{EMPTY, QUAD, Words};

/// Bounds of the blocks of a quad for all headings.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeadingBounds {
    /// All numbers count in this unit of votes.
    unit: u16,
    /// The greatest of each block, in units.
    pub(in crate::search) greatest: [u16; QUAD],
    pub(in crate::search) chunks: Vec<Chunk>,
}

/// Bounds at the headings of a chunk.
#[derive(Debug, Clone)]
pub(in crate::search) struct Chunk {
    /// What was noted after each group but the last: sums in units.
    pub after: [Planes; GROUPS - 1],
    /// The greatest of each block, in units.
    pub greatest: [u16; QUAD],
    /// Which headings matter.
    pub valid: u128,
    /// Those at which a block was bounded and may have as many votes as was asked for.
    pub reach: Words,
}

impl HeadingBounds {
    /// Allocates bounds at some headings, a word a chunk; nothing is left of what
    /// was there.
    pub(in crate::search) fn fit(&mut self, unit: u16, headings: impl Iterator<Item = u128>) {
        self.unit = unit;
        self.greatest = [0; QUAD];
        self.chunks.clear();
        let chunks = headings.map(|valid| Chunk {
            after: [[EMPTY; bits::PLANES]; GROUPS - 1],
            greatest: [0; QUAD],
            valid,
            reach: EMPTY,
        });
        self.chunks.extend(chunks);
    }

    /// The greatest bound of a block.
    pub(crate) fn greatest(&self, place: usize) -> u16 {
        self.unit * self.greatest[place]
    }

    /// The same, chunk by chunk.
    pub(crate) fn by_chunk(&self, place: usize) -> impl Iterator<Item = u16> {
        self.chunks
            .iter()
            .map(move |chunk| self.unit * chunk.greatest[place])
    }

    /// Windows of the headings at which a block reaches what was asked for.
    pub(crate) fn reach(&self, place: usize) -> impl Iterator<Item = (usize, u64)> {
        bits::windows(self.chunks.len(), move |chunk| {
            bits::of_block(&self.chunks[chunk].reach, place)
        })
    }
}
