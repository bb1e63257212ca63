//! Candidates below the floor of a search: the best poses of the blocks
//! with the highest bounds.
//!
//! The search proves which poses are above its floor. Below, where proofs would cost more
//! than they are worth, single blocks are searched: the 8 × 8 with the highest bounds, and
//! in each of those one pose of the 4 × 4 and the heading with the highest bound. The
//! search bounded all blocks that the floor leaves. If those are too few, the coarse blocks
//! with the highest bounds are split.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::atomic::Ordering;

use messages::Vote;

use super::descent;
use super::queue::BoundedBlock;
use crate::search::bounds::heading_bounds::HeadingBounds;
use crate::search::bounds::interval_bounds::IntervalBounds;
use crate::search::bounds::set_bounds::SetBounds;
use crate::search::index::SearchIndex;
use crate::search::index::bits;
use crate::search::index::intervals::{BlockIntervals, SIDE};
use crate::search::index::sets::Quad;
use crate::search::index::within::Size;
use crate::search::index::within::quarters;
use crate::search::leaves::block_ranges::BlockRanges;
use crate::search::task::Task;
use crate::votes::Distinct;

/// Number of coarse blocks that are split for each candidate that is wanted.
const COARSE_SHARE: usize = 6;

/// On large maps, one in this number of coarse blocks is split.
const COARSE_PART: usize = 16;

/// Share of the bound of the last coarse block that is split, in parts of 16, which the
/// bounds of all searched 8 × 8 blocks likely reach.
const LIKELY_SIXTEENTHS: u32 = 13;

/// Headings with less than this share of a block's highest bound, in parts of
/// 32, are skipped.
const MIN_BOUND_RATIO: u32 = 31;

/// Finds candidates on one thread, independent of how the search went.
pub(in crate::search) struct Alternatives<'a> {
    task: &'a Task<'a>,
    scratch: &'a mut Scratch,
}

/// Buffers for finding candidates, kept from scan to scan.
#[derive(Debug, Default)]
pub(in crate::search) struct Scratch {
    bounds: SetBounds,
    intervals: BlockIntervals,
    interval_bounds: IntervalBounds,
    block_ranges: BlockRanges,
    coarse: Vec<BoundedBlock>,
    /// Blocks of 8 × 8 cells that are searched.
    fine: Greatest,
    spots: Vec<Spot>,
    /// Poses or spots that are distinct.
    pub distinct: Vec<Vote>,
    /// Poses that were found.
    pub votes: Vec<Vote>,
}

/// A block of 4 × 4 cells at a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Spot {
    bound: u16,
    block: Reverse<usize>,
    heading: Reverse<usize>,
}

impl<'a> Alternatives<'a> {
    pub(in crate::search) fn new(task: &'a Task<'a>, scratch: &'a mut Scratch) -> Self {
        scratch.bounds.fit(&task.programs.sets, task.headings());
        scratch
            .block_ranges
            .prepare(task.grid, &task.space.directions);
        Alternatives { task, scratch }
    }

    /// Leaves poses of the blocks with the highest bounds in its scratch buffer, in no order,
    /// at most `wanted`. `floor` is that with which the search ended; `scratches` are its
    /// buffers if it bounded all blocks that the floor leaves. Blocks whose bounds are below
    /// `least` are not searched.
    pub(in crate::search) fn find(
        &mut self,
        wanted: usize,
        (floor, least): (u16, u16),
        scratches: Option<&[descent::Scratch]>,
    ) {
        self.scratch.fine.start(wanted);
        match scratches {
            Some(scratches) => {
                let bounded = scratches.iter().flat_map(|scratch| &scratch.fine);
                let left = bounded.filter(|&&(bound, _)| bound >= floor);
                left.for_each(|&bounded| self.scratch.fine.offer(bounded));
            }
            None => {
                self.take_highest(usize::MAX);
                self.choose(floor);
            }
        }
        if !self.scratch.fine.is_full() {
            self.split_highest(wanted, least);
        }
        self.scratch.spots.clear();
        for i in 0..self.scratch.fine.blocks().len() {
            let Reverse(bounded) = self.scratch.fine.blocks()[i];
            let spot = self.best_spot(bounded);
            self.scratch.spots.extend(spot);
        }
        let Scratch {
            spots, distinct, ..
        } = &mut *self.scratch;
        spots.sort_unstable_by(|a, b| b.cmp(a));
        let columns = self.task.index.intervals.columns;
        let mut distinct = Distinct::new(self.task.space, wanted, distinct);
        spots.retain(|spot| distinct.take(&spot.corner(columns)));
        self.scratch.votes.clear();
        for i in 0..self.scratch.spots.len() {
            let vote = self.count(self.scratch.spots[i]);
            self.scratch.votes.extend(vote);
        }
    }

    /// Chooses 8 × 8 blocks in the coarse ones with the highest bounds, none of them below
    /// `least`.
    fn split_highest(&mut self, wanted: usize, least: u16) {
        let part = self.task.coarse_bounds.len() / COARSE_PART;
        self.take_highest(part.max(COARSE_SHARE * wanted));
        // With a guess of what the last one reaches, most others are dropped early.
        let last = self.scratch.coarse.last().map_or(0, |&(bound, _)| bound);
        let likely = (u32::from(last) * LIKELY_SIXTEENTHS / 16) as u16;
        for floor in [likely.max(least), least] {
            self.scratch.fine.start(wanted);
            self.choose(floor);
            if self.scratch.fine.is_full() {
                break;
            }
        }
    }

    /// Takes the `count` coarse blocks with the highest bounds.
    fn take_highest(&mut self, count: usize) {
        let task = self.task;
        let blocks = (0..task.coarse_bounds.len())
            .filter(|&block| task.index.within.holds(Size::Coarse, block))
            .map(|block| bounded(task, block));
        self.scratch.coarse.clear();
        self.scratch.coarse.extend(blocks);
        keep_greatest(&mut self.scratch.coarse, count);
    }

    /// Chooses the 8 × 8 blocks with the highest bounds, none of them below a floor,
    /// in the coarse ones that were taken.
    fn choose(&mut self, floor: u16) {
        let SearchIndex { fine, within, .. } = self.task.index;
        let Scratch {
            bounds,
            coarse,
            fine: chosen,
            ..
        } = &mut *self.scratch;
        for &(bound, Reverse(block)) in &*coarse {
            // Where enough are known, others matter only if they are as good.
            let least = floor.max(chosen.least());
            if bound < least {
                break;
            }
            let quad = within.quad(Size::Fine, fine, block as usize);
            let bounds = bound_fine(self.task, &quad, least, bounds);
            let bounded = quad
                .blocks()
                .map(|(place, block)| (bounds.greatest(place), Reverse(block as u32)));
            let left = bounded.filter(|&(bound, _)| bound >= least);
            left.for_each(|bounded| chosen.offer(bounded));
        }
    }

    /// Returns the small block in an 8 × 8 block, and the heading, with the highest bound.
    fn best_spot(&mut self, (bound, Reverse(block)): BoundedBlock) -> Option<Spot> {
        let (index, block) = (self.task.index, block as usize);
        let Scratch {
            bounds,
            intervals,
            interval_bounds,
            ..
        } = &mut *self.scratch;
        let (quad, place) = index.fine.place_of(block);
        let quad = index.fine.searched(quad, |other| other == block);
        let least = (u32::from(bound) * MIN_BOUND_RATIO / 32) as u16;
        let bounds = bound_fine(self.task, &quad, least.max(1), bounds);
        let program = &self.task.programs.interval;
        let sides = (index.intervals.columns, index.intervals.rows);
        let smalls = quarters(block, index.fine.columns, sides);
        let mut best: Option<Spot> = None;
        for small in smalls.filter(|&block| index.intervals.ids.holds(block)) {
            index.intervals.read(small, intervals);
            for (first, among) in bounds.reach(place) {
                let least = best.map_or(1, |spot| spot.bound);
                if program.bound::<false>(intervals, (first, among), least, interval_bounds) {
                    let spot = |lane| Spot {
                        bound: interval_bounds.all[lane],
                        block: Reverse(small),
                        heading: Reverse(first + lane),
                    };
                    best = best.max(bits::ones(among).map(spot).max());
                }
            }
        }
        best
    }

    /// Returns the best pose of a spot; `None` if no cell of it is searched or no beam votes.
    fn count(&mut self, spot: Spot) -> Option<Vote> {
        let index = self.task.index;
        let (Reverse(block), Reverse(heading)) = (spot.block, spot.heading);
        let view = self.task.view();
        let block_ranges = &mut self.scratch.block_ranges;
        block_ranges.enter((&view, &index.within.limits), &index.intervals, block);
        let counts = self.task.programs.leaf.count(block_ranges, &view, heading);
        let open = block_ranges.open();
        let votes = counts.iter().zip(open).map(|(count, open)| count & open);
        let (intensity, Reverse(i)) = votes.zip((0..).map(Reverse)).max()?;
        let (x, y) = block_ranges.cell(i);
        (intensity > 0).then_some(Vote {
            x: x as u16,
            y: y as u16,
            heading: heading as u16,
            intensity,
        })
    }
}

/// Bounds 8 × 8 blocks in the chunks of headings in which they may have `least` votes.
fn bound_fine<'a>(
    task: &Task<'_>,
    quad: &Quad,
    least: u16,
    bounds: &'a mut SetBounds,
) -> &'a HeadingBounds {
    // A coarse block has the index of the quad of 8 × 8 blocks within.
    let known = (task.by_chunk(quad.index), least);
    let blocks = (&task.index.fine, quad);
    task.programs.sets.bound(blocks, Some(known), bounds)
}

fn bounded(task: &Task<'_>, block: usize) -> BoundedBlock {
    let bound = task.coarse_bounds[block].load(Ordering::Relaxed);
    (bound, Reverse(block as u32))
}

/// The `count` greatest blocks of those offered.
#[derive(Debug, Default)]
struct Greatest {
    count: usize,
    /// Kept blocks, the least on top.
    kept: BinaryHeap<Reverse<BoundedBlock>>,
}

impl Greatest {
    /// Starts with nothing, to keep this many blocks, at least one.
    fn start(&mut self, count: usize) {
        self.count = count;
        self.kept.clear();
    }

    fn is_full(&self) -> bool {
        self.kept.len() == self.count
    }

    /// Returns the bound below which no block will be kept.
    fn least(&self) -> u16 {
        match self.kept.peek() {
            Some(&Reverse((least, _))) if self.is_full() => least,
            _ => 0,
        }
    }

    fn offer(&mut self, bounded: BoundedBlock) {
        if bounded.0 < self.least() {
            return;
        }
        self.kept.push(Reverse(bounded));
        if self.kept.len() > self.count {
            self.kept.pop();
        }
    }

    /// Returns the blocks that were kept, in no order.
    fn blocks(&self) -> &[Reverse<BoundedBlock>] {
        self.kept.as_slice()
    }
}

impl Spot {
    /// Returns the spot as a pose, for telling spots apart; `columns` is the number of blocks
    /// along x.
    fn corner(&self, columns: usize) -> Vote {
        let (Reverse(block), Reverse(heading)) = (self.block, self.heading);
        Vote {
            x: (block % columns * SIDE) as u16,
            y: (block / columns * SIDE) as u16,
            heading: heading as u16,
            intensity: self.bound,
        }
    }
}

/// Keeps the `count` greatest, in descending order.
fn keep_greatest<T: Ord>(all: &mut Vec<T>, count: usize) {
    if count < all.len() {
        all.select_nth_unstable_by(count, |a, b| b.cmp(a));
        all.truncate(count);
    }
    all.sort_unstable_by(|a, b| b.cmp(a));
}
