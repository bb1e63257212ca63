//! Upper bounds of the votes in the blocks of a quad, by heading.

use crate::search::index::bits;
use crate::simd::words::{EMPTY, QUAD, Words};

/// Bounds of the blocks of a quad for all headings.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeadingBounds {
    /// Unit of all numbers, in votes.
    unit: u16,
    /// Greatest bound of each block, in units.
    pub(in crate::parts::search) greatest: [u16; QUAD],
    pub(in crate::parts::search) chunks: Vec<Chunk>,
}

/// Bounds at the headings of a chunk.
#[derive(Debug, Clone)]
pub(in crate::parts::search) struct Chunk {
    /// Greatest bound of each block, in units.
    pub greatest: [u16; QUAD],
    /// A bit for each heading that matters.
    pub valid: u128,
    /// Headings at which each block was bounded and may have as many votes as was asked for.
    pub reach: Words,
}

impl HeadingBounds {
    /// Allocates bounds at some headings, a word of `headings` for each chunk; drops earlier
    /// bounds.
    pub(in crate::parts::search) fn fit(
        &mut self,
        unit: u16,
        headings: impl Iterator<Item = u128>,
    ) {
        self.unit = unit;
        self.greatest = [0; QUAD];
        self.chunks.clear();
        let chunks = headings.map(|valid| Chunk {
            greatest: [0; QUAD],
            valid,
            reach: EMPTY,
        });
        self.chunks.extend(chunks);
    }

    /// Returns the greatest bound of a block, in votes.
    pub(crate) fn greatest(&self, place: usize) -> u16 {
        self.unit * self.greatest[place]
    }

    /// Returns the greatest bound of a block in each chunk, in votes.
    pub(crate) fn by_chunk(&self, place: usize) -> impl Iterator<Item = u16> {
        self.chunks
            .iter()
            .map(move |chunk| self.unit * chunk.greatest[place])
    }

    /// Returns the headings at which a block reaches the votes asked for, as windows of bits:
    /// the first heading, and a bit for each from there on.
    pub(crate) fn reach(&self, place: usize) -> impl Iterator<Item = (usize, u64)> {
        bits::windows(self.chunks.len(), move |chunk| {
            bits::of_block(&self.chunks[chunk].reach, place)
        })
    }
}
