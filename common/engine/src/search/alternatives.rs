//! Candidates below the floor of a search: the best poses of the blocks that
//! promise most.
//!
//! The search proves which poses stand above its floor. Below, where proofs
//! would cost more than they are worth, single blocks are looked into: coarse
//! ones by their promise, the 8 × 8 in them by their bounds, and in each of
//! those one pose of the 4 × 4 and the heading with the highest bound.

use std::cmp::Reverse;
use std::sync::atomic::Ordering;

use messages::Vote;

use super::bits;
use super::descent::quarters;
use super::interval_bounds::IntervalBounds;
use super::intervals::{BlockIntervals, SIDE};
use super::outlook::{CELLS, Outlook};
use super::sectors;
use super::set_bounds::{CHUNK, SetBounds};
use super::task::Task;
use super::within::Size;
use crate::votes::Distinct;

/// Coarse blocks that are split for each candidate that is wanted.
const COARSE_SHARE: usize = 6;

/// On large maps, one of so many coarse blocks is split.
const COARSE_PART: usize = 16;

/// Blocks of 8 × 8 cells that are looked into for each candidate.
const FINE_SHARE: usize = 1;

/// Headings with less than this share of a block's highest bound, in parts of
/// 32, are not looked at.
const LEAST_THIRTY_SECONDTHS: u32 = 31;

/// Looks for candidates on one thread, whatever the search did.
pub(super) struct Alternatives<'a> {
    task: &'a Task<'a>,
    bounds: SetBounds,
    intervals: BlockIntervals,
    interval_bounds: IntervalBounds,
    outlook: Outlook,
}

/// A block of 4 × 4 cells at a heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Spot {
    bound: u16,
    block: Reverse<usize>,
    heading: Reverse<usize>,
}

impl<'a> Alternatives<'a> {
    pub(super) fn new(task: &'a Task<'a>) -> Self {
        Alternatives {
            task,
            bounds: task.programs.fine.bounds(task.headings()),
            intervals: BlockIntervals::default(),
            interval_bounds: IntervalBounds::new(),
            outlook: Outlook::new(task.grid, &task.space.directions),
        }
    }

    /// Poses of the blocks that promise most, in no order, at most so many.
    pub(super) fn find(&mut self, wanted: usize) -> Vec<Vote> {
        let part = self.task.promises.len() / COARSE_PART;
        let coarse = self.most_promising(part.max(COARSE_SHARE * wanted));
        let mut fine = self.bound_all(&coarse);
        keep_greatest(&mut fine, FINE_SHARE * wanted);
        let spots = fine
            .iter()
            .filter_map(|&(_, Reverse(block))| self.best_spot(block as usize));
        let mut spots: Vec<Spot> = spots.collect();
        spots.sort_unstable_by(|a, b| b.cmp(a));
        let mut distinct = Distinct::new(self.task.space, wanted);
        spots.retain(|spot| distinct.take(&self.corner(spot)));
        spots
            .into_iter()
            .filter_map(|spot| self.count(spot))
            .collect()
    }

    /// A spot as a pose, by which spots are told apart.
    fn corner(&self, spot: &Spot) -> Vote {
        let (Reverse(block), Reverse(heading)) = (spot.block, spot.heading);
        let columns = self.task.index.intervals.columns;
        Vote {
            x: (block % columns * SIDE) as u16,
            y: (block / columns * SIDE) as u16,
            heading: heading as u16,
            intensity: spot.bound,
        }
    }

    /// The coarse blocks that promise most.
    fn most_promising(&self, count: usize) -> Vec<(u16, Reverse<u32>)> {
        let promises = self.task.promises.iter().zip(0..);
        let within = &self.task.index.within;
        let mut blocks: Vec<_> = promises
            .map(|(promise, block)| (promise.load(Ordering::Relaxed), Reverse(block)))
            .filter(|&(_, Reverse(block))| within.holds(Size::Coarse, block as usize))
            .collect();
        keep_greatest(&mut blocks, count);
        blocks
    }

    /// The bounds of the 8 × 8 blocks in coarse ones.
    fn bound_all(&mut self, coarse: &[(u16, Reverse<u32>)]) -> Vec<(u16, Reverse<u32>)> {
        let (index, program) = (self.task.index, &self.task.programs.fine);
        let sides = (index.fine.columns, index.fine.rows);
        let within =
            |block: &(u16, Reverse<u32>)| quarters(block.1.0 as usize, index.coarse.columns, sides);
        let bound = |block: usize| {
            program.bound(&index.fine, block, 0, &mut self.bounds);
            (self.bounds.greatest(), Reverse(block as u32))
        };
        let blocks = coarse.iter().flat_map(within);
        let blocks = blocks.filter(|&block| index.within.holds(Size::Fine, block));
        blocks.map(bound).collect()
    }

    /// Where in an 8 × 8 block the bound of a small block is highest.
    fn best_spot(&mut self, block: usize) -> Option<Spot> {
        let index = self.task.index;
        self.task
            .programs
            .fine
            .bound(&index.fine, block, 0, &mut self.bounds);
        let greatest = u32::from(self.bounds.greatest());
        let least = (greatest * LEAST_THIRTY_SECONDTHS / 32) as u16;
        let masks: Vec<_> = self.bounds.at_least(least.max(1), &self.bounds).collect();
        let sides = (index.intervals.columns, index.intervals.rows);
        let mut best = None;
        let smalls = quarters(block, index.fine.columns, sides);
        for small in smalls.filter(|&block| index.within.holds(Size::Small, block)) {
            index.intervals.read(small, &mut self.intervals);
            for (chunk, mask) in masks.iter().enumerate() {
                let mut mask = *mask;
                while let Some((first, among)) = bits::take_window(&mut mask) {
                    let first = chunk * CHUNK + first;
                    best = best.max(self.best_in_window(small, first, among, best));
                }
            }
        }
        best
    }

    /// The best spot at some headings, if it may be better than that so far.
    fn best_in_window(
        &mut self,
        block: usize,
        first: usize,
        among: u64,
        so_far: Option<Spot>,
    ) -> Option<Spot> {
        let (program, bounds) = (&self.task.programs.interval, &mut self.interval_bounds);
        let least = so_far.map_or(1, |spot| spot.bound);
        if !program.bound(&self.intervals, first, among, least, bounds) {
            return None;
        }
        let spot = |lane| Spot {
            bound: bounds.all[lane],
            block: Reverse(block),
            heading: Reverse(first + lane),
        };
        bits::ones(among).map(spot).max()
    }

    /// The best pose of a spot; `None` where nobody can stand or nothing votes.
    fn count(&mut self, spot: Spot) -> Option<Vote> {
        let Task {
            index, grid, space, ..
        } = self.task;
        let (Reverse(block), Reverse(heading)) = (spot.block, spot.heading);
        let map = (*grid, &index.within.limits);
        self.outlook.enter(map, &index.intervals, block);
        let prepared = (*grid, &index.steps, &space.directions);
        let mut counts = [0; CELLS];
        for sector in 0..sectors::count(self.task.programs.beams) {
            let program = &self.task.programs.leaf;
            program.add(&mut self.outlook, prepared, sector, heading, &mut counts);
        }
        let open = self.outlook.open();
        let votes = counts.iter().zip(&open).map(|(count, open)| count & open);
        let (intensity, Reverse(i)) = votes.zip((0..).map(Reverse)).max()?;
        let (x, y) = self.outlook.cell(i);
        (intensity > 0).then_some(Vote {
            x: x as u16,
            y: y as u16,
            heading: heading as u16,
            intensity,
        })
    }
}

/// Keeps the greatest so many, in falling order.
fn keep_greatest<T: Ord>(all: &mut Vec<T>, count: usize) {
    all.sort_unstable_by(|a, b| b.cmp(a));
    all.truncate(count);
}
