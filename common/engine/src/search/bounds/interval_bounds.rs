//! Upper bounds of the votes in a small block from its intervals of ranges.
//!
//! A beam votes most for the range of an interval that is nearest to its reading. Intervals
//! of adjacent directions are adjacent in memory, so one table look-up bounds a beam at 64
//! headings.

use super::interval_program::{IntervalBeam, IntervalProgram, Order};
use super::set_bounds::Rests;
use crate::search::index::intervals::BlockIntervals;
use crate::simd::headings::{HEADINGS, HeadingLanes};
use crate::simd::{Kernel, Set};

/// Upper bounds of a block's votes at adjacent headings.
#[derive(Debug, Clone)]
pub(crate) struct IntervalBounds {
    /// Bounds for all beams together.
    pub all: [u16; HEADINGS],
    /// Bounds for each sector of beams, in the order in which they are counted.
    pub sectors: Vec<[u8; HEADINGS]>,
    /// Headings at which each beam may vote, as bits, with the beams in that order.
    pub voting: Vec<u64>,
}

impl Default for IntervalBounds {
    fn default() -> Self {
        IntervalBounds {
            all: [0; HEADINGS],
            sectors: Vec::new(),
            voting: Vec::new(),
        }
    }
}

/// Headings at which a block may matter, all of them less than [`HEADINGS`] after the
/// first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub first: u16,
    /// Bit `i` is set if heading `first + i` may matter.
    pub among: u64,
    /// Most votes that the beams from each group on give at any of these headings.
    pub rests: Rests,
}

/// A block to bound, and the votes below which it is given up.
struct BoundQuery<'a> {
    order: &'a Order,
    block: &'a BlockIntervals,
    /// First heading, and a bit for each that matters from there on.
    heading: usize,
    among: u64,
    /// Votes that any of them must reach.
    least: u16,
    /// Most votes that the remaining beams give when this many sectors or groups are complete.
    rests: &'a [u16],
}

impl IntervalProgram {
    /// Bounds the votes of a block at the 64 headings from `heading` on; `among` selects those
    /// that matter. Returns true if any of these may have `least` votes; if not, the bounds are
    /// left unfinished.
    pub(crate) fn bound(
        &self,
        block: &BlockIntervals,
        heading: usize,
        among: u64,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        let query = BoundQuery {
            order: &self.by_sector,
            block,
            heading,
            among,
            least,
            rests: &self.possible_from,
        };
        self.run::<true>(&query, bounds)
    }

    /// Does the same at the headings of a window known from the enclosing block, but finds no
    /// bounds of sectors and beams. The window's limits for the remaining beams tell sooner
    /// whether any heading may have `least` votes.
    pub(crate) fn bound_within(
        &self,
        block: &BlockIntervals,
        window: &Window,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        let query = BoundQuery {
            order: &self.by_group,
            block,
            heading: usize::from(window.first),
            among: window.among,
            least,
            rests: &window.rests,
        };
        self.run::<false>(&query, bounds)
    }

    /// `DETAILED` finds the bounds of sectors and beams, too.
    fn run<const DETAILED: bool>(
        &self,
        query: &BoundQuery<'_>,
        bounds: &mut IntervalBounds,
    ) -> bool {
        self.simd.run(Bounding::<DETAILED> {
            program: self,
            query,
            bounds,
        })
    }

    #[inline(always)]
    fn run_on<S: Set, const DETAILED: bool>(
        &self,
        set: S,
        query: &BoundQuery<'_>,
        bounds: &mut IntervalBounds,
    ) -> bool {
        let rows = query.block.rows();
        let mut sums = S::Headings::no_sums(set);
        let mut alive = false;
        bounds.sectors.clear();
        bounds.voting.clear();
        for (beams, complete) in query.order.pieces() {
            let mut votes = S::Headings::none(set);
            for beam in beams {
                let direction = self.direction(beam, query.heading);
                let of_beam = S::Headings::of_beam(set, &beam.votes, rows.from(direction));
                votes = votes.add(of_beam);
                if DETAILED {
                    bounds.voting.push(of_beam.present());
                }
            }
            if DETAILED {
                bounds.sectors.push(votes.to_bytes());
            }
            sums = votes.add_to(sums);
            let missing = query.least.saturating_sub(query.rests[complete]);
            alive = S::Headings::at_least(set, sums, missing) & query.among != 0;
            if !alive {
                break;
            }
        }
        bounds.all = S::Headings::votes(set, sums);
        alive
    }

    #[inline(always)]
    fn direction(&self, beam: &IntervalBeam, heading: usize) -> usize {
        let direction = heading + usize::from(beam.bearing);
        if direction < self.directions {
            direction
        } else {
            direction - self.directions
        }
    }
}

/// Kernel that bounds a block; `DETAILED` finds the bounds of sectors and beams, too.
struct Bounding<'a, const DETAILED: bool> {
    program: &'a IntervalProgram,
    query: &'a BoundQuery<'a>,
    bounds: &'a mut IntervalBounds,
}

impl<const DETAILED: bool> Kernel for Bounding<'_, DETAILED> {
    type Result = bool;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> bool {
        self.program
            .run_on::<S, DETAILED>(set, self.query, self.bounds)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicU16;

    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::search::bounds::set_bounds::SetBounds;
    use crate::search::index::SearchIndex;
    use crate::search::index::bits;
    use crate::search::index::within::quarters;
    use crate::search::task::lead::Lead;
    use crate::search::task::{Programs, Shared, Task};
    use crate::simd::Simd;
    use crate::testing::{any_grid, any_scan, space_of};
    use crate::votes::CollectConfig;

    proptest! {
        #[test]
        fn what_is_known_of_the_block_around_changes_no_bound(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(80)],
            share in 0.5..=1.0f64,
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let program = scan.program(&space);
            let index = SearchIndex::new(&grid, &space);
            let SearchIndex { coarse, fine, intervals, .. } = &index;
            let mut read = BlockIntervals::default();
            for instruction_set in InstructionSet::available() {
                let mut shared = Shared::default();
                let (scan, lead) = ((&program, &space), Lead::default());
                let task = Task::new(&mut shared, Simd::new(instruction_set), &index, &grid, scan, (CollectConfig::default(), &lead));
                let Programs { sets, interval, .. } = task.programs;
                let (mut outer_bounds, mut inner_bounds) = (SetBounds::default(), SetBounds::default());
                outer_bounds.fit(sets, task.headings());
                inner_bounds.fit(sets, task.headings());
                let (mut alone, mut noted) = (IntervalBounds::default(), IntervalBounds::default());
                for block in 0..fine.blocks() {
                    let (outside, place) = fine.place_of(block);
                    let (outer_quad, outer_place) = coarse.place_of(outside);
                    let outer_quad = coarse.searched(outer_quad, |_| true);
                    let around = sets.bound((coarse, &outer_quad), None, &mut outer_bounds);
                    let known: Vec<_> = around.by_chunk(outer_place).map(AtomicU16::new).collect();
                    let quad = fine.searched(outside, |other| other == block);
                    let greatest = sets.bound((fine, &quad), None, &mut inner_bounds).greatest(place);
                    let least = (f64::from(greatest) * share) as u16;
                    let known = Some((&known[..], least.max(1)));
                    let within = sets.bound((fine, &quad), known, &mut inner_bounds);
                    for (first, among) in within.reach(place) {
                        let rests = sets.rests((within, place), (first, among));
                        let window = Window { first: first as u16, among, rests };
                        let sides = (intervals.columns, intervals.rows);
                        let smalls = quarters(block, fine.columns, sides);
                        for small in smalls.filter(|&small| intervals.ids.holds(small)) {
                            intervals.read(small, &mut read);
                            let plain = interval.bound(&read, first, among, least, &mut alone);
                            let found = interval.bound_within(&read, &window, least, &mut noted);
                            prop_assert_eq!(found, plain);
                            for lane in bits::ones(among).filter(|_| plain) {
                                prop_assert_eq!(noted.all[lane], alone.all[lane]);
                            }
                        }
                    }
                }
            }
        }
    }
}
