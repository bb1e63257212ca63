//! Which blocks of a strip are wanted, and their numbers.

use super::transpose::TILE;
use crate::search::index::block_ids::BlockIds;

/// The blocks of a strip.
pub(super) struct StripBlocks<'a> {
    ids: &'a BlockIds,
    /// The first one, and how much farther each next one is.
    places: (usize, usize),
    /// A bit for each that is wanted.
    wanted: Vec<u64>,
}

impl<'a> StripBlocks<'a> {
    pub(super) fn new(ids: &'a BlockIds, places: (usize, usize), blocks: usize) -> Self {
        let holds = |block: usize| u64::from(ids.holds(places.0 + block * places.1));
        let word = |first: usize| {
            let tile = first..blocks.min(first + TILE);
            tile.fold(0, |word, block| word | holds(block) << (block - first))
        };
        StripBlocks {
            ids,
            places,
            wanted: (0..blocks).step_by(TILE).map(word).collect(),
        }
    }

    /// How many tiles they are.
    pub(super) fn tiles(&self) -> usize {
        self.wanted.len()
    }

    /// Which are wanted of `count` from `start` on, which are a part of a tile.
    #[inline(always)]
    pub(super) fn wanted(&self, start: usize, count: usize) -> u64 {
        let word = self
            .wanted
            .get(start / TILE)
            .map_or(0, |word| word >> (start % TILE));
        word & (u64::MAX >> (TILE - count))
    }

    /// The number of a wanted one.
    #[inline(always)]
    pub(super) fn id(&self, block: usize) -> usize {
        self.ids.before(self.places.0 + block * self.places.1)
    }
}
