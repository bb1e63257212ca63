//! Blocks that wait to be searched, the highest bound first.

use std::cmp::Reverse;
use std::num::NonZeroU32;

use crate::search::index::prefetch::prefetch;

/// The blocks that wait.
///
/// Blocks of 4 × 4 cells have tighter bounds than the blocks that they came from, and so
/// would all wait until nothing larger is left. Yet the best pose is in one of the first,
/// and the sooner it is known, the fewer others have to be searched.
#[derive(Debug, Default)]
pub(in crate::search) struct Queue {
    larger: ByBound,
    leaves: ByBound,
}

impl Queue {
    pub(in crate::search) fn clear(&mut self) {
        self.larger.clear();
        self.leaves.clear();
    }

    pub(in crate::search) fn push(&mut self, block: Block) {
        match block.level {
            Level::Leaf { .. } => self.leaves.push(block),
            _ => self.larger.push(block),
        }
    }

    /// Takes the next block with a bound that is not below the floor: the one with the highest
    /// bound or, if `prefers_leaves`, the best of the smallest.
    pub(in crate::search) fn pop(&mut self, prefers_leaves: bool, floor: u16) -> Option<Block> {
        loop {
            let blocks = self.next_of(prefers_leaves);
            let block = blocks.pop()?;
            if block.bound >= floor {
                return Some(block);
            }
            // Those after it have no higher bounds.
            blocks.clear();
        }
    }

    /// Returns the block that would be popped now, if it reaches the floor.
    pub(in crate::search) fn peek(&mut self, prefers_leaves: bool) -> Option<Block> {
        self.next_of(prefers_leaves).peek()
    }

    fn next_of(&mut self, prefers_leaves: bool) -> &mut ByBound {
        let is_leaf = match (self.leaves.greatest(), self.larger.greatest()) {
            (Some(leaf), Some(larger)) => prefers_leaves || leaf > larger,
            (leaf, _) => leaf.is_some(),
        };
        if is_leaf {
            &mut self.leaves
        } else {
            &mut self.larger
        }
    }

    pub(in crate::search) fn iter(&self) -> impl Iterator<Item = &Block> {
        self.larger.iter().chain(self.leaves.iter())
    }
}

/// Blocks by their bounds, of which there are few different ones. Of equal ones the last
/// that was pushed comes first.
#[derive(Debug, Default)]
struct ByBound {
    /// Place of the last block with each bound.
    last: Vec<Option<Place>>,
    /// A bit for each bound that a block has.
    bounds: Vec<u64>,
    /// All blocks that were pushed, each with the place of the one before with the same bound.
    blocks: Vec<(Block, Option<Place>)>,
}

/// A place in [`ByBound::blocks`], counted from 1 on.
type Place = NonZeroU32;

impl ByBound {
    fn clear(&mut self) {
        self.last.clear();
        self.bounds.clear();
        self.blocks.clear();
    }

    fn push(&mut self, block: Block) {
        let bound = usize::from(block.bound);
        if bound >= self.last.len() {
            self.last.resize(bound + 1, None);
            self.bounds.resize(bound / 64 + 1, 0);
        }
        self.blocks.push((block, self.last[bound]));
        self.last[bound] = Place::new(self.blocks.len() as u32);
        self.bounds[bound / 64] |= 1 << (bound % 64);
    }

    /// Returns the greatest bound that a block has.
    fn greatest(&mut self) -> Option<usize> {
        while let Some(&bounds) = self.bounds.last() {
            if let Some(highest) = bounds.checked_ilog2() {
                return Some(64 * (self.bounds.len() - 1) + highest as usize);
            }
            self.bounds.pop();
            self.last.truncate(64 * self.bounds.len());
        }
        None
    }

    fn peek(&mut self) -> Option<Block> {
        let bound = self.greatest()?;
        let &(block, before) = self.at(self.last[bound]?);
        if let Some(before) = before {
            // It is likely the next one, and may be anywhere in memory.
            prefetch(std::slice::from_ref(self.at(before)));
        }
        Some(block)
    }

    fn pop(&mut self) -> Option<Block> {
        let bound = self.greatest()?;
        let (block, before) = *self.at(self.last[bound]?);
        self.last[bound] = before;
        if before.is_none() {
            self.bounds[bound / 64] &= !(1 << (bound % 64));
        }
        Some(block)
    }

    fn iter(&self) -> impl Iterator<Item = &Block> {
        self.last.iter().flat_map(|&last| {
            let last = last.map(|last| self.at(last));
            let all = std::iter::successors(last, |(_, before)| before.map(|place| self.at(place)));
            all.map(|(block, _)| block)
        })
    }

    fn at(&self, place: Place) -> &(Block, Option<Place>) {
        &self.blocks[place.get() as usize - 1]
    }
}

/// A block in the queue.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Block {
    /// Votes that none of its poses exceeds; the queue is ordered by it.
    pub bound: u16,
    pub index: u32,
    pub level: Level,
}

/// The bound of a block, and its index; of equal bounds the lowest index comes first.
pub(in crate::search) type BoundedBlock = (u16, Reverse<u32>);

/// Size of a block, and the places of the headings known for it.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) enum Level {
    /// 16 × 16 cells.
    Coarse,
    /// 8 × 8 cells, at the headings of these windows.
    Fine { start: u32, end: u32 },
    /// 4 × 4 cells, at these candidate headings.
    Leaf { start: u32, end: u32 },
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn blocks_come_with_the_greatest_bounds_first_and_each_once(
            steps in vec(prop_oneof![2 => (0u16..300).prop_map(Some), 1 => Just(None)], 0..200),
        ) {
            let mut blocks = ByBound::default();
            let mut waiting = Vec::new();
            for (index, step) in (0..).zip(steps) {
                if let Some(bound) = step {
                    blocks.push(Block { bound, index, level: Level::Coarse });
                    waiting.push((bound, index));
                    continue;
                }
                // Of equal ones the last comes first.
                let greatest = waiting.iter().copied().max();
                waiting.retain(|&other| Some(other) != greatest);
                prop_assert_eq!(blocks.greatest(), greatest.map(|(bound, _)| bound.into()));
                let [next, popped] = [blocks.peek(), blocks.pop()]
                    .map(|block| block.map(|block| (block.bound, block.index)));
                prop_assert_eq!([next, popped], [greatest; 2]);
                let mut left: Vec<_> = blocks.iter().map(|block| (block.bound, block.index)).collect();
                left.sort_unstable_by_key(|&(_, index)| index);
                prop_assert_eq!(&left, &waiting);
            }
        }

        #[test]
        fn leaves_come_first_where_they_are_preferred_and_nothing_below_the_floor(
            steps in vec(
                prop_oneof![
                    3 => (0u16..50, any::<bool>()).prop_map(Ok),
                    2 => (any::<bool>(), 0u16..60).prop_map(Err),
                ],
                0..100,
            ),
        ) {
            let mut queue = Queue::default();
            let mut waiting: Vec<(bool, u16, u32)> = Vec::new();
            for (index, step) in (0..).zip(steps) {
                match step {
                    Ok((bound, is_leaf)) => {
                        let leaf = Level::Leaf { start: 0, end: 0 };
                        let level = if is_leaf { leaf } else { Level::Coarse };
                        queue.push(Block { bound, index, level });
                        waiting.push((is_leaf, bound, index));
                    }
                    Err((prefers_leaves, floor)) => {
                        let popped = queue.pop(prefers_leaves, floor).map(|block| block.index);
                        // Those below the floor are given up as soon as one is met.
                        let next = |waiting: &[(bool, u16, u32)]| {
                            let key = |&(leaf, bound, index): &(bool, u16, u32)| {
                                (prefers_leaves && leaf, bound, !leaf, index)
                            };
                            waiting.iter().copied().max_by_key(key)
                        };
                        let mut expected = None;
                        while let Some(first) = next(&waiting) {
                            let (leaf, bound, index) = first;
                            if bound >= floor {
                                expected = Some(index);
                                waiting.retain(|&other| other != first);
                                break;
                            }
                            waiting.retain(|&(other, ..)| other != leaf);
                        }
                        prop_assert_eq!(popped, expected);
                    }
                }
            }
            prop_assert_eq!(queue.iter().count(), waiting.len());
        }
    }
}
