//! Blocks that wait to be searched, the most promising first.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// The blocks that wait.
///
/// Blocks of 4 × 4 cells have tighter bounds than those that they came of, and so
/// would all wait until nothing larger is left. Yet in one of the first lies the best
/// pose, and the sooner it is known, the less else needs to be looked at.
#[derive(Debug, Default)]
pub(super) struct Queue {
    larger: BinaryHeap<Block>,
    leaves: BinaryHeap<Block>,
}

impl Queue {
    pub(super) fn clear(&mut self) {
        self.larger.clear();
        self.leaves.clear();
    }

    pub(super) fn push(&mut self, block: Block) {
        match block.level {
            Level::Leaf { .. } => self.leaves.push(block),
            _ => self.larger.push(block),
        }
    }

    /// The next block with a bound that is not below the floor: the most promising
    /// one, or if `dives` that of the smallest.
    pub(super) fn pop(&mut self, dives: bool, floor: u16) -> Option<Block> {
        loop {
            let blocks = self.next_of(dives);
            let block = blocks.pop()?;
            if block.bound >= floor {
                return Some(block);
            }
            // Those behind it have no higher bounds.
            blocks.clear();
        }
    }

    /// What would be popped now.
    pub(super) fn peek(&mut self, dives: bool) -> Option<Block> {
        self.next_of(dives).peek().copied()
    }

    fn next_of(&mut self, dives: bool) -> &mut BinaryHeap<Block> {
        let is_leaf = match (self.leaves.peek(), self.larger.peek()) {
            (Some(leaf), Some(larger)) => dives || leaf > larger,
            (leaf, _) => leaf.is_some(),
        };
        if is_leaf {
            &mut self.leaves
        } else {
            &mut self.larger
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Block> {
        self.larger.iter().chain(&self.leaves)
    }
}

/// A block in the queue.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    /// What none of its poses has more than: the order of the queue.
    pub bound: u16,
    pub index: u32,
    pub level: Level,
}

/// The bound of a block, and which it is; of equal ones the first comes first.
pub(super) type Promise = (u16, Reverse<u32>);

/// How large a block is, and what is known of it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Level {
    /// A quad of 16 × 16 cells each.
    Coarse,
    /// 8 × 8 cells, at the headings of these windows.
    Fine { start: u32, end: u32 },
    /// 4 × 4 cells, at these candidate headings.
    Leaf { start: u32, end: u32 },
}

impl Level {
    /// From the largest blocks on.
    pub(super) fn number(self) -> usize {
        match self {
            Level::Coarse => 0,
            Level::Fine { .. } => 1,
            Level::Leaf { .. } => 2,
        }
    }
}

impl Block {
    fn key(&self) -> (u16, u32) {
        (self.bound, self.index)
    }
}

impl PartialEq for Block {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Block {}

impl PartialOrd for Block {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Block {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}
