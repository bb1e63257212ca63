//! Wanted blocks of a strip, and their numbers.

use super::transpose::TILE;
use crate::search::index::block_ids::BlockIds;

/// The blocks of a strip.
pub(super) struct StripBlocks<'a> {
    ids: &'a BlockIds,
    /// Place of the first block in the grid, and the distance to each next one.
    places: (usize, usize),
    /// A bit for each wanted block, a word for each tile.
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

    /// Number of tiles.
    pub(super) fn tiles(&self) -> usize {
        self.wanted.len()
    }

    /// Returns a bit for each wanted block of the `count` from `start` on, which must be in one
    /// tile.
    #[inline(always)]
    pub(super) fn wanted(&self, start: usize, count: usize) -> u64 {
        let word = self
            .wanted
            .get(start / TILE)
            .map_or(0, |word| word >> (start % TILE));
        word & (u64::MAX >> (TILE - count))
    }

    /// Returns the number of a wanted block.
    #[inline(always)]
    pub(super) fn id(&self, block: usize) -> usize {
        self.ids.before(self.places.0 + block * self.places.1)
    }
}
