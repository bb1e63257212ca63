//! Candidates below the floor of a search: the best poses of the blocks with the highest bounds.
//!
//! The search proves which poses are above its floor. Below, where proofs would cost more
//! than they are worth, the coarse blocks with the highest bounds are split, and of their quarters
//! those with the highest bounds give a pose each: the best one of the 4 × 4 cells and the heading
//! with the highest bound.

use std::cmp::Reverse;
use std::sync::atomic::Ordering;

use messages::Vote;

use crate::search::bounds::interval_bounds::IntervalBounds;
use crate::search::bounds::set_bounds::SetBounds;
use crate::search::index::bits;
use crate::search::index::intervals::{BlockIntervals, SIDE};
use crate::search::index::sets::Quad;
use crate::search::leaves::block_ranges::BlockRanges;
use crate::search::task::Task;
use crate::votes::Distinct;

/// Number of coarse blocks that are split for each candidate that is wanted.
const COARSE_SHARE: usize = 4;

/// Headings with less than this share of a block's highest bound, in parts of
/// 32, are skipped.
const MIN_BOUND_RATIO: u32 = 31;

/// Buffers for finding candidates on one thread, independent of how the search went; kept from
/// scan to scan.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub bounds: SetBounds,
    intervals: BlockIntervals,
    interval_bounds: IntervalBounds,
    block_ranges: BlockRanges,
    coarse: Vec<Bounded>,
    fine: Vec<Bounded>,
    spots: Vec<Spot>,
    /// Poses or spots that are distinct.
    pub distinct: Vec<Vote>,
    /// Poses that were found.
    pub votes: Vec<Vote>,
}

/// The bound of a block, and its index; of equal bounds the lowest index comes first.
type Bounded = (u16, Reverse<usize>);

/// A block of 4 × 4 cells at a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Spot {
    bound: u16,
    block: Reverse<usize>,
    heading: Reverse<usize>,
}

impl Scratch {
    /// Leaves poses of the `wanted` blocks with the highest bounds in the buffer, in no order.
    /// Blocks whose bounds are below `least` are not searched.
    pub(crate) fn find(&mut self, task: &Task<'_>, wanted: usize, least: u16) {
        self.bounds.fit(&task.shared.sets, task.headings());
        self.block_ranges.prepare(task.grid, &task.space.directions);
        let Scratch {
            bounds,
            coarse,
            fine,
            ..
        } = self;
        let bound = |block: usize| task.shared.coarse_bounds[block].load(Ordering::Relaxed);
        let blocks = 0..task.index.coarse.blocks();
        let searched = blocks.filter(|&block| task.index.coarse.searched.holds(block));
        coarse.clear();
        coarse.extend(searched.map(|block| (bound(block), Reverse(block))));
        keep_greatest(coarse, COARSE_SHARE * wanted);
        fine.clear();
        let mut least = least;
        for coarse in coarse.chunks(wanted) {
            for &(bound, Reverse(block)) in coarse {
                if bound < least {
                    break;
                }
                let quad = task.index.fine.searched_quad(block);
                let found = bound_fine(task, &quad, least, bounds);
                let bounded = quad
                    .blocks()
                    .map(|(place, block)| (found.greatest(place), Reverse(block)));
                fine.extend(bounded.filter(|&(bound, _)| bound >= least));
            }
            keep_greatest(fine, wanted);
            // Others matter only if they are as good as the last one that is kept.
            if fine.len() == wanted {
                least = fine[wanted - 1].0;
            }
        }
        let mut spots = std::mem::take(&mut self.spots);
        spots.clear();
        for i in 0..self.fine.len() {
            spots.extend(self.best_spot(task, self.fine[i]));
        }
        spots.sort_unstable_by(|a, b| b.cmp(a));
        let columns = task.index.intervals.columns;
        let mut distinct = Distinct::new(task.space, wanted, &mut self.distinct);
        spots.retain(|spot| distinct.take(&spot.corner(columns)));
        self.votes.clear();
        for &spot in &spots {
            let vote = self.count(task, spot);
            self.votes.extend(vote);
        }
        self.spots = spots;
    }

    /// Returns the small block in an 8 × 8 block, and the heading, with the highest bound.
    fn best_spot(&mut self, task: &Task<'_>, (bound, Reverse(block)): Bounded) -> Option<Spot> {
        let index = task.index;
        let Scratch {
            bounds,
            intervals,
            interval_bounds,
            ..
        } = self;
        let (quad, place) = index.fine.alone(block);
        let least = (u32::from(bound) * MIN_BOUND_RATIO / 32) as u16;
        let bounds = bound_fine(task, &quad, least.max(1), bounds);
        let program = &task.shared.interval;
        let mut best: Option<Spot> = None;
        for small in index.intervals.quarters(block) {
            index.intervals.read(small, intervals);
            for (first, among) in bounds.reach(place) {
                let least = best.map_or(1, |spot| spot.bound);
                if program.bound::<false>(intervals, first, least, interval_bounds) {
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
    fn count(&mut self, task: &Task<'_>, spot: Spot) -> Option<Vote> {
        let index = task.index;
        let (Reverse(block), Reverse(heading)) = (spot.block, spot.heading);
        let view = task.view();
        let block_ranges = &mut self.block_ranges;
        block_ranges.enter((&view, &index.limits), &index.intervals, block);
        let program = &task.shared.leaf;
        let counts = program.count(task.program, block_ranges, &view, heading);
        let votes = counts
            .iter()
            .zip(&block_ranges.open)
            .map(|(count, open)| count & open);
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
) -> &'a SetBounds {
    // A coarse block has the index of the quad of 8 × 8 blocks within.
    let known = (task.by_chunk(quad.index), least);
    let blocks = (&task.index.fine, quad);
    task.shared.sets.bound(blocks, Some(known), bounds)
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
fn keep_greatest(all: &mut Vec<Bounded>, count: usize) {
    if count < all.len() {
        all.select_nth_unstable_by(count, |a, b| b.cmp(a));
        all.truncate(count);
    }
    all.sort_unstable_by(|a, b| b.cmp(a));
}
