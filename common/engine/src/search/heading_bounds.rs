//! What a block of cells is bounded by at each heading: numbers as planes.

use super::bits::{self, EMPTY, Planes, Row};
use super::set_program::GROUPS;

/// Bounds of a block for all headings.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeadingBounds {
    /// All numbers count in this unit of votes.
    unit: u16,
    /// The greatest, in units.
    pub(super) greatest: u16,
    pub(super) chunks: Vec<Chunk>,
}

/// Bounds at the headings of a chunk.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    /// Sums in units.
    pub sums: Planes,
    /// What the sums were after each group but the last.
    pub after: [Planes; GROUPS - 1],
    /// Which headings matter.
    pub valid: Row,
    /// Those of them that may have as many votes as was asked for.
    pub reach: Row,
}

impl HeadingBounds {
    /// Makes room for bounds at some headings, a row a chunk; nothing is left of what
    /// was there.
    pub(super) fn fit(&mut self, unit: u16, headings: impl Iterator<Item = Row>) {
        self.unit = unit;
        self.greatest = 0;
        self.chunks.clear();
        let chunks = headings.map(|valid| Chunk {
            sums: [EMPTY; bits::PLANES],
            after: [[EMPTY; bits::PLANES]; GROUPS - 1],
            valid,
            reach: EMPTY,
        });
        self.chunks.extend(chunks);
    }

    /// The greatest bound.
    pub(crate) fn greatest(&self) -> u16 {
        self.unit * self.greatest
    }

    /// For each chunk, the headings at which a block that was bounded within another
    /// one reaches what was asked for.
    pub(crate) fn reach(&self) -> impl Iterator<Item = Row> {
        self.chunks.iter().map(|chunk| chunk.reach)
    }

    /// For each chunk, the headings at which the bound is at least `least`.
    pub(crate) fn at_least(&self, least: u16) -> impl Iterator<Item = Row> {
        let least = least.div_ceil(self.unit);
        let at_least = move |chunk: &Chunk| {
            bits::at_least(bits::PLANES, |plane| chunk.sums[plane], least, chunk.valid)
        };
        self.chunks.iter().map(at_least)
    }
}
