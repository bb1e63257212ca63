//! One branch-and-bound search: from large blocks down to poses, those with the highest
//! bound first.

use std::collections::BinaryHeap;
use std::ops::Range;
use std::sync::atomic::Ordering;

use messages::Vote;

use crate::search::bounds::interval_bounds::IntervalBounds;
use crate::search::bounds::set_bounds::SetBounds;
use crate::search::index::SearchIndex;
use crate::search::index::bits;
use crate::search::index::intervals::{BlockIntervals, CELLS};
use crate::search::leaves::block_ranges::BlockRanges;
use crate::search::leaves::leaf::Count;
use crate::search::task::budget::{Budget, Tally};
use crate::search::task::{End, Task};
use crate::simd::headings::HEADINGS;
use crate::votes::Collector;

/// A block in the queue. The one with the highest bound comes first, of equal ones the
/// smallest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Block {
    /// Votes that none of its poses exceeds.
    bound: u16,
    level: Level,
    index: u32,
}

/// Size of a block, and the places of the headings known for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// 16 × 16 cells.
    Coarse,
    /// 8 × 8 cells, at the headings of these windows.
    Fine { start: u32, end: u32 },
    /// 4 × 4 cells, at headings from this one on: those of the bits.
    Leaf { first: u16, among: u64 },
}

/// Buffers of one thread's search, kept from scan to scan.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    set_bounds: SetBounds,
    intervals: BlockIntervals,
    interval_bounds: IntervalBounds,
    block_ranges: BlockRanges,
    /// The votes of a block of 4 × 4 cells at each of [`HEADINGS`].
    counts: Vec<Count>,
    queue: BinaryHeap<Block>,
    /// Headings at which blocks of 8 × 8 cells may matter: the first, and a bit for each from
    /// there on.
    windows: Vec<(usize, u64)>,
    /// Poses that matter.
    pub collector: Collector,
    /// Most votes of any pose that the search did not reach because it was cut.
    pub left: u16,
    tally: Tally,
}

impl Scratch {
    /// Prepares the buffers for a task; drops the contents of the one before.
    fn start(&mut self, task: &Task<'_>) {
        self.set_bounds.fit(&task.shared.sets, task.headings());
        self.block_ranges.prepare(task.grid, &task.space.directions);
        self.counts.resize(HEADINGS, Count::default());
        self.queue.clear();
        self.windows.clear();
        self.collector.start(task.config);
        self.left = 0;
        self.tally = Tally::default();
    }
}

/// One thread's part of a search.
pub(crate) struct Descent<'a> {
    task: &'a Task<'a>,
    scratch: &'a mut Scratch,
    budget: Budget,
}

impl<'a> Descent<'a> {
    /// Starts with one of `parts` of the coarse blocks.
    pub(crate) fn new(
        task: &'a Task<'a>,
        scratch: &'a mut Scratch,
        (part, parts): (usize, usize),
    ) -> Self {
        scratch.start(task);
        let budget = Budget::new(task.brute_force, task.config.most_steps(), parts);
        let mut descent = Descent {
            task,
            scratch,
            budget,
        };
        descent.bound_coarse(part, parts);
        descent
    }

    /// Searches until there is nothing left that may matter.
    pub(crate) fn run(mut self, stop: &dyn Fn() -> bool) -> End {
        loop {
            if let Some(end) = self.step(0.0, stop) {
                return end;
            }
        }
    }

    /// Cost that was spent so far.
    pub(crate) fn spent(&self) -> f64 {
        self.budget.spent()
    }

    /// Searches the next block, and returns how the search ended, if it did. `elsewhere` is the
    /// cost that was spent on other maps that are searched with this one.
    pub(crate) fn step(&mut self, elsewhere: f64, stop: &dyn Fn() -> bool) -> Option<End> {
        let Some(block) = self.next() else {
            return Some(End::Done);
        };
        if stop() {
            return Some(End::Stopped);
        }
        let (level, index) = (block.level, block.index as usize);
        match level {
            Level::Coarse => self.split_coarse(index),
            Level::Fine { start, end } => {
                self.split_fine(index, &(start as usize..end as usize));
            }
            Level::Leaf { first, among } => self.count(index, first.into(), among),
        }
        let Scratch {
            tally,
            set_bounds,
            block_ranges,
            ..
        } = &mut *self.scratch;
        tally.reads = std::mem::take(&mut set_bounds.reads);
        tally.casts = std::mem::take(&mut block_ranges.casts);
        let cost = std::mem::take(tally).cost(self.task.program.beams());
        self.budget.spend(cost);
        // Some pose has to be found: without any it would seem that no beam votes.
        if self.budget.is_used_up(elsewhere) && self.task.best() > 0 {
            self.scratch.left = self.scratch.queue.peek().map_or(0, |block| block.bound);
            return Some(End::Done);
        }
        self.budget.is_hopeless(elsewhere).then_some(End::Hopeless)
    }

    /// Bounds one of `parts` of the coarse quads, and queues them.
    fn bound_coarse(&mut self, part: usize, parts: usize) {
        let (coarse, program) = (&self.task.index.coarse, &self.task.shared.sets);
        // Neighbouring blocks are alike, so parts take them in turn. All bounds are needed, even if
        // another part gives up: candidates come from them.
        let own = (part..coarse.quads()).step_by(parts);
        let own = own.map(|quad| coarse.searched_quad(quad));
        let own = own.filter(|quad| quad.blocks().next().is_some());
        let Scratch {
            set_bounds, queue, ..
        } = &mut *self.scratch;
        program.bound_all(coarse, own, set_bounds, |quad, found| {
            for (place, block) in quad.blocks() {
                let bound = found.greatest(place);
                self.task.shared.coarse_bounds[block].store(bound, Ordering::Relaxed);
                for (known, bound) in self.task.by_chunk(block).iter().zip(found.by_chunk(place)) {
                    known.store(bound, Ordering::Relaxed);
                }
                queue.push(Block {
                    bound,
                    index: block as u32,
                    level: Level::Coarse,
                });
            }
        });
        // The tally counts only the cost of blocks that are taken from the queue.
        set_bounds.reads = 0;
    }

    /// Takes the next block that may matter from the queue.
    fn next(&mut self) -> Option<Block> {
        self.scratch.collector.raise_best(self.task.best());
        let floor = self.scratch.collector.floor();
        let next = self.scratch.queue.pop();
        next.filter(|block| block.bound >= floor)
    }

    fn push(&mut self, bound: u16, index: usize, level: Level) {
        if bound >= self.scratch.collector.floor() {
            self.scratch.queue.push(Block {
                bound,
                index: index as u32,
                level,
            });
        }
    }

    /// Bounds and queues the blocks of 8 × 8 cells in one of 16 × 16.
    fn split_coarse(&mut self, index: usize) {
        let fine = &self.task.index.fine;
        let program = &self.task.shared.sets;
        let quad = fine.searched_quad(index);
        let known = (self.task.by_chunk(index), self.scratch.collector.floor());
        program.bound((fine, &quad), Some(known), &mut self.scratch.set_bounds);
        for (place, block) in quad.blocks() {
            self.queue_fine(block, place);
        }
    }

    /// Queues a block of 8 × 8 cells that was just bounded, at the headings at which it
    /// may matter.
    fn queue_fine(&mut self, index: usize, place: usize) {
        let Scratch {
            windows,
            set_bounds: bounds,
            ..
        } = &mut *self.scratch;
        let start = windows.len();
        windows.extend(bounds.reach(place));
        let (start, end) = (start as u32, windows.len() as u32);
        if start < end {
            let bound = bounds.greatest(place);
            self.push(bound, index, Level::Fine { start, end });
        }
    }

    /// Queues the blocks of 4 × 4 cells in one of 8 × 8, at the headings at which they may matter.
    fn split_fine(&mut self, index: usize, windows: &Range<usize>) {
        let whole = &self.task.index.intervals;
        let program = &self.task.shared.interval;
        for block in whole.quarters(index) {
            whole.read(block, &mut self.scratch.intervals);
            for window in windows.clone() {
                let Scratch {
                    intervals,
                    interval_bounds: bounds,
                    windows,
                    collector,
                    tally,
                    ..
                } = &mut *self.scratch;
                let ((first, among), floor) = (windows[window], collector.floor());
                tally.windows += 1;
                if program.bound::<false>(intervals, first, floor, bounds) {
                    let (among, bound) = bounds.reach(floor, among);
                    let first = first as u16;
                    self.push(bound, block, Level::Leaf { first, among });
                }
            }
        }
    }

    /// Counts the votes of a block's poses at the headings that bits select from a first one on.
    fn count(&mut self, index: usize, first: usize, among: u64) {
        let SearchIndex {
            intervals, limits, ..
        } = self.task.index;
        let Scratch {
            block_ranges,
            interval_bounds: bounds,
            collector,
            tally,
            ..
        } = &mut *self.scratch;
        block_ranges.enter((&self.task.view(), limits), intervals, index);
        let (program, floor) = (&self.task.shared.interval, collector.floor());
        tally.windows += 1;
        if program.bound::<true>(&block_ranges.intervals, first, floor, bounds) {
            let (among, _) = bounds.reach(floor, among);
            self.count_at(first, among);
        }
    }

    /// Counts sector by sector at headings from `first` on, until no pose can reach the floor
    /// with the bounds of the remaining sectors.
    fn count_at(&mut self, first: usize, among: u64) {
        let view = self.task.view();
        for lane in bits::ones(among) {
            self.scratch.counts[lane] = Count::default();
        }
        let mut rest = self.scratch.interval_bounds.all;
        let mut alive = among;
        let floor = self.scratch.collector.floor();
        let IntervalBounds {
            sectors, voting, ..
        } = &self.scratch.interval_bounds;
        for (sector, bounds) in sectors.iter().enumerate() {
            self.scratch.tally.sectors += u64::from(alive.count_ones());
            let rays = (&mut self.scratch.block_ranges, &view);
            let program = &self.task.shared.leaf;
            let beams = (sector, &voting[..]);
            let scan = self.task.program;
            program.add(scan, rays, beams, (first, alive), &mut self.scratch.counts);
            let mut still = 0;
            for lane in bits::ones(alive) {
                rest[lane] -= u16::from(bounds[lane]);
                let most = self.scratch.counts[lane].most;
                still |= u64::from(most + rest[lane] >= floor) << lane;
            }
            alive = still;
            if alive == 0 {
                break;
            }
        }
        for lane in bits::ones(alive) {
            let votes = self.scratch.counts[lane].votes;
            self.take((first + lane) as u16, &votes);
        }
        self.task.raise_best(self.scratch.collector.best_taken());
    }

    fn take(&mut self, heading: u16, counts: &[u16; CELLS]) {
        let open = self.scratch.block_ranges.open;
        self.scratch.collector.evaluated += CELLS as u64;
        for (i, &intensity) in counts.iter().enumerate() {
            if open[i] != 0 {
                let (x, y) = self.scratch.block_ranges.cell(i);
                let vote = Vote {
                    x: x as u16,
                    y: y as u16,
                    heading,
                    intensity,
                };
                self.scratch.collector.take(vote);
            }
        }
    }
}
