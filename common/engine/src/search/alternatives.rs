//! Candidates below the floor of a search: the best poses of the blocks that
//! promise most.
//!
//! The search proves which poses stand above its floor. Below, where proofs
//! would cost more than they are worth, single blocks are looked into: the 8 × 8
//! with the highest bounds, and in each of those one pose of the 4 × 4 and the
//! heading with the highest bound. The search bounded all blocks that the floor
//! leaves. Where those are too few, the coarse blocks with the highest bounds are split.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::atomic::Ordering;

use messages::Vote;

use super::bits;
use super::descent::{self, quarters};
use super::index::SearchIndex;
use super::interval_bounds::IntervalBounds;
use super::intervals::{BlockIntervals, SIDE};
use super::outlook::Outlook;
use super::queue::Promise;
use super::set_bounds::SetBounds;
use super::sets::Quad;
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
    room: &'a mut Room,
}

/// What candidates are looked for with, kept from scan to scan.
#[derive(Debug, Default)]
pub(super) struct Room {
    bounds: SetBounds,
    coarse_bounds: SetBounds,
    /// Headings at which a block of 8 × 8 cells may matter, a word a chunk.
    masks: Vec<u128>,
    intervals: BlockIntervals,
    interval_bounds: IntervalBounds,
    outlook: Outlook,
    coarse: Vec<Promise>,
    /// Blocks of 8 × 8 cells that are looked into.
    fine: Greatest,
    spots: Vec<Spot>,
    /// Poses or spots that are distinct.
    pub distinct: Vec<Vote>,
    /// What was found.
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
    pub(super) fn new(task: &'a Task<'a>, room: &'a mut Room) -> Self {
        room.bounds.fit(&task.programs.sets, task.headings());
        room.outlook.prepare(task.grid, &task.space.directions);
        Alternatives { task, room }
    }

    /// Leaves in its room poses of the blocks that promise most, in no order, at
    /// most so many. The search ended with a floor, in rooms that are given if it
    /// bounded all blocks that the floor leaves.
    pub(super) fn find(&mut self, wanted: usize, floor: u16, rooms: Option<&[descent::Room]>) {
        let count = FINE_SHARE * wanted;
        self.room.fine.start(count);
        match rooms {
            Some(rooms) => {
                let bounded = rooms.iter().flat_map(|room| &room.fine);
                let left = bounded.filter(|&&(bound, _)| bound >= floor);
                left.for_each(|&promise| self.room.fine.offer(promise));
            }
            None => {
                self.take_most_promising(usize::MAX);
                self.choose(floor);
            }
        }
        if !self.room.fine.is_full() {
            let part = self.task.coarse_bounds.len() / COARSE_PART;
            self.take_most_promising(part.max(COARSE_SHARE * wanted));
            self.room.fine.start(count);
            self.choose(1);
        }
        self.room.spots.clear();
        for i in 0..self.room.fine.blocks().len() {
            let Reverse((_, Reverse(block))) = self.room.fine.blocks()[i];
            let spot = self.best_spot(block as usize);
            self.room.spots.extend(spot);
        }
        let Room {
            spots, distinct, ..
        } = &mut *self.room;
        spots.sort_unstable_by(|a, b| b.cmp(a));
        let columns = self.task.index.intervals.columns;
        let mut distinct = Distinct::new(self.task.space, wanted, distinct);
        spots.retain(|spot| distinct.take(&spot.corner(columns)));
        self.room.votes.clear();
        for i in 0..self.room.spots.len() {
            let vote = self.count(self.room.spots[i]);
            self.room.votes.extend(vote);
        }
    }

    /// Takes the coarse blocks that promise most.
    fn take_most_promising(&mut self, count: usize) {
        let task = self.task;
        let blocks = (0..task.coarse_bounds.len())
            .filter(|&block| task.index.within.holds(Size::Coarse, block))
            .map(|block| promise(task, block));
        self.room.coarse.clear();
        self.room.coarse.extend(blocks);
        keep_greatest(&mut self.room.coarse, count);
    }

    /// Chooses the 8 × 8 blocks with the highest bounds, none of them below a floor,
    /// in the coarse ones that were taken.
    fn choose(&mut self, floor: u16) {
        let (coarse, within) = (&self.task.index.coarse, &self.task.index.within);
        let (program, headings) = (&self.task.programs.sets, self.task.headings());
        self.room.coarse_bounds.fit(program, headings);
        for i in 0..self.room.coarse.len() {
            let taken @ (bound, Reverse(block)) = self.room.coarse[i];
            if bound < self.least(floor) {
                break;
            }
            // All of a quad that were taken are bounded with the first of them.
            let (quad, _) = coarse.place_of(block as usize);
            let quad = within.quad(Size::Coarse, coarse, quad);
            let mut others = quad.blocks().map(|(_, block)| promise(self.task, block));
            if others.all(|other| other <= taken) {
                self.choose_in(&quad, floor);
            }
        }
    }

    /// Chooses such blocks in those of a coarse quad that were taken.
    fn choose_in(&mut self, quad: &Quad, floor: u16) {
        let SearchIndex {
            coarse,
            fine,
            within,
            ..
        } = self.task.index;
        let program = &self.task.programs.sets;
        let known = (self.task.by_chunk(quad.index), self.least(floor));
        program.bound_again((coarse, quad), known, &mut self.room.coarse_bounds);
        for (place, block) in quad.blocks() {
            let least = self.least(floor);
            let promise = promise(self.task, block);
            let is_taken = self.room.coarse.last().is_some_and(|&last| promise >= last);
            if !is_taken || promise.0 < least {
                continue;
            }
            let quad = within.quad(Size::Fine, fine, block);
            let Room {
                bounds,
                coarse_bounds,
                fine: chosen,
                ..
            } = &mut *self.room;
            let around = (&coarse_bounds.found, place);
            let reach = program.bound_within((fine, &quad), least, around, bounds);
            for (place, block) in quad.blocks().filter(|&(place, _)| reach[place]) {
                chosen.offer((bounds.found.greatest(place), Reverse(block as u32)));
            }
        }
    }

    /// What a block must reach to be chosen: where enough are known, others need not be
    /// bounded to the end.
    fn least(&self, floor: u16) -> u16 {
        floor.max(self.room.fine.least())
    }

    /// Where in an 8 × 8 block the bound of a small block is highest.
    fn best_spot(&mut self, block: usize) -> Option<Spot> {
        let (index, program) = (self.task.index, &self.task.programs.sets);
        let Room { bounds, masks, .. } = &mut *self.room;
        let (quad, place) = index.fine.place_of(block);
        let quad = index.fine.sought(quad, |other| other == block);
        let bounds = program.bound((&index.fine, &quad), bounds);
        let greatest = u32::from(bounds.greatest(place));
        let least = (greatest * LEAST_THIRTY_SECONDTHS / 32) as u16;
        masks.clear();
        masks.extend(bounds.at_least(place, least.max(1)));
        let sides = (index.intervals.columns, index.intervals.rows);
        let mut best = None;
        let smalls = quarters(block, index.fine.columns, sides);
        let masks = std::mem::take(masks);
        for small in smalls.filter(|&block| index.within.holds(Size::Small, block)) {
            index.intervals.read(small, &mut self.room.intervals);
            for (first, among) in bits::windows(masks.len(), |chunk| masks[chunk]) {
                best = best.max(self.best_in_window(small, first, among, best));
            }
        }
        self.room.masks = masks;
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
        let program = &self.task.programs.interval;
        let Room {
            intervals,
            interval_bounds: bounds,
            ..
        } = &mut *self.room;
        let least = so_far.map_or(1, |spot| spot.bound);
        if !program.bound(intervals, first, among, least, bounds) {
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
        let index = self.task.index;
        let (Reverse(block), Reverse(heading)) = (spot.block, spot.heading);
        let map = (self.task.grid, &index.within.limits);
        let outlook = &mut self.room.outlook;
        outlook.enter(map, &index.intervals, block);
        let view = self.task.view();
        let counts = self.task.programs.leaf.count(outlook, &view, heading);
        let open = outlook.open();
        let votes = counts.iter().zip(&open).map(|(count, open)| count & open);
        let (intensity, Reverse(i)) = votes.zip((0..).map(Reverse)).max()?;
        let (x, y) = outlook.cell(i);
        (intensity > 0).then_some(Vote {
            x: x as u16,
            y: y as u16,
            heading: heading as u16,
            intensity,
        })
    }
}

/// What a coarse block promises.
fn promise(task: &Task<'_>, block: usize) -> Promise {
    let bound = task.coarse_bounds[block].load(Ordering::Relaxed);
    (bound, Reverse(block as u32))
}

/// The greatest so many of what was offered.
#[derive(Debug, Default)]
struct Greatest {
    count: usize,
    /// The least first.
    kept: BinaryHeap<Reverse<Promise>>,
}

impl Greatest {
    /// Starts with nothing; so many will be kept, of which there is at least one.
    fn start(&mut self, count: usize) {
        self.count = count;
        self.kept.clear();
    }

    fn is_full(&self) -> bool {
        self.kept.len() == self.count
    }

    /// Nothing below this will be kept.
    fn least(&self) -> u16 {
        match self.kept.peek() {
            Some(&Reverse((least, _))) if self.is_full() => least,
            _ => 0,
        }
    }

    fn offer(&mut self, promise: Promise) {
        if promise.0 < self.least() {
            return;
        }
        self.kept.push(Reverse(promise));
        if self.kept.len() > self.count {
            self.kept.pop();
        }
    }

    /// What was kept, in no order.
    fn blocks(&self) -> &[Reverse<Promise>] {
        self.kept.as_slice()
    }
}

impl Spot {
    /// The spot as a pose, by which spots are told apart; blocks lie in so many
    /// columns.
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

/// Keeps the greatest so many, in falling order.
fn keep_greatest<T: Ord>(all: &mut Vec<T>, count: usize) {
    if count < all.len() {
        all.select_nth_unstable_by(count, |a, b| b.cmp(a));
        all.truncate(count);
    }
    all.sort_unstable_by(|a, b| b.cmp(a));
}
