//! Upper bounds of the votes in blocks from their sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share
//! of its votes. Where a block sees no range within a window, at a heading, its
//! share is missing there. The bits of a window are read at the beam's bearing:
//! the whole bytes of it by where reading starts, the rest by grouping beams
//! and shifting the sums of each group once. What is done is done for the four
//! blocks of a quad, side by side.

use std::sync::atomic::{AtomicU16, Ordering};

use super::bits::{self, EMPTY, QUAD, Words};
use super::group::{Aligned, Carries, Group};
use super::heading_bounds::HeadingBounds;
use super::quad_rows::{QuadRows, Reader};
use super::set_program::{GROUPS, SetProgram};
use super::sets::{Quad, RangeSets};
use super::words::{BitWords, Several};
#[cfg(any(target_arch = "x86_64", test))]
use crate::instruction_set::InstructionSet;

/// Most chunks that are bounded at a time by any instruction set.
const MOST_AT_A_TIME: usize = 3;

/// What the beams from each group on give at most, in votes: more for the first
/// group than they can, and 0 behind the last.
pub(crate) type Rests = [u16; GROUPS + 1];

/// How blocks are bounded.
#[derive(Debug, Clone, Copy)]
enum How<'a> {
    /// At all headings.
    Plain,
    /// The same, and the sums after each group are noted for blocks within. Only in
    /// chunks that matter, if it is known which do.
    Noting(Option<Known<'a>>),
    /// As blocks within another one, as long as any heading may have so many units.
    Within(Around<'a>, u16),
}

/// Bounds of a quad that are known, chunk by chunk, and those that matter, in votes.
pub(crate) type Known<'a> = (&'a [AtomicU16], u16);

/// The bounds of a block around others: of a quad, and its place there.
pub(crate) type Around<'a> = (&'a HeadingBounds, usize);

/// Bounds of the blocks of a quad, and room to find them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetBounds {
    pub found: HeadingBounds,
    /// What was read in all, in words.
    pub reads: u64,
    /// The chunks in which any heading matters.
    chunks: Vec<usize>,
    rows: QuadRows,
    carries: Carries,
}

impl SetBounds {
    /// Makes room for the bounds by a program of blocks at some headings, a word a
    /// chunk; nothing is left of what another program had.
    pub(crate) fn fit(&mut self, program: &SetProgram, headings: impl Iterator<Item = u128>) {
        self.found.fit(program.unit, headings);
        self.reads = 0;
        self.rows.fit(&program.layout);
        let carries = program.groups().iter().map(Group::carries).max();
        for rows in &mut self.carries {
            rows.resize(MOST_AT_A_TIME * (carries.unwrap_or(0)), Aligned(EMPTY));
        }
    }
}

impl SetProgram {
    /// What the beams from each group on give at most at the headings of a window, by
    /// bounds of a block that were found within those of a block around.
    pub(crate) fn rests(&self, (bounds, place): Around<'_>, (first, among): (usize, u64)) -> Rests {
        let chunks = &bounds.chunks;
        let others = self.groups().len().saturating_sub(1);
        let mut rests = Rests::default();
        rests[0] = u16::MAX;
        for (group, rest) in rests.iter_mut().enumerate().take(others + 1).skip(1) {
            // The last groups were added first.
            let sums = |chunk: usize, plane: usize| chunks[chunk].after[others - group][plane];
            let sums = |plane| {
                let of_chunk = |chunk| bits::of_block(&sums(chunk, plane), place);
                bits::window_of(chunks.len(), of_chunk, first)
            };
            *rest = self.unit * bits::greatest(self.planes, sums, among);
        }
        rests
    }

    /// Bounds the votes of blocks in chunks in which any may have as many votes as
    /// matter.
    pub(crate) fn bound_again<'a>(
        &self,
        (sets, quad): (&RangeSets, &Quad),
        known: Known<'_>,
        bounds: &'a mut SetBounds,
    ) -> &'a HeadingBounds {
        self.run((sets, quad), How::Noting(Some(known)), bounds);
        &bounds.found
    }

    /// Bounds the votes of blocks at all headings.
    pub(crate) fn bound<'a>(
        &self,
        (sets, quad): (&RangeSets, &Quad),
        bounds: &'a mut SetBounds,
    ) -> &'a HeadingBounds {
        self.run((sets, quad), How::Noting(None), bounds);
        &bounds.found
    }

    /// Bounds those of blocks within one that was bounded by the same beams. Whether any
    /// heading of each may have `least` votes; if not, its bounds are not finished.
    ///
    /// Only headings matter at which the block around reaches `least`, and what it says
    /// of beams that are still to be added tells sooner whether any does.
    pub(crate) fn bound_within(
        &self,
        blocks: (&RangeSets, &Quad),
        least: u16,
        around: Around<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; QUAD] {
        let least = least.div_ceil(self.unit);
        self.run(blocks, How::Within(around, least), bounds)
    }

    /// The greatest bound of each block.
    pub(crate) fn bound_all(
        &self,
        sets: &RangeSets,
        quads: impl Iterator<Item = Quad>,
        bounds: &mut SetBounds,
        mut take: impl FnMut(&Quad, &HeadingBounds),
    ) {
        let mut quads = quads.peekable();
        while let Some(quad) = quads.next() {
            if let Some(next) = quads.peek() {
                sets.prefetch(next.index);
            }
            self.run((sets, &quad), How::Plain, bounds);
            take(&quad, &bounds.found);
        }
    }

    fn run(
        &self,
        blocks: (&RangeSets, &Quad),
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; QUAD] {
        match self.instruction_set {
            // SAFETY: the processor has the instruction set, or it would not be chosen.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { self.run_avx512(blocks, how, bounds) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { self.run_avx2(blocks, how, bounds) },
            _ => self.run_with::<Words>(blocks, how, bounds),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
    fn run_avx512(
        &self,
        blocks: (&RangeSets, &Quad),
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; QUAD] {
        self.run_with::<super::words::Avx512>(blocks, how, bounds)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn run_avx2(
        &self,
        blocks: (&RangeSets, &Quad),
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; QUAD] {
        self.run_with::<super::words::Avx2>(blocks, how, bounds)
    }

    #[inline(always)]
    fn run_with<W: BitWords>(
        &self,
        (sets, quad): (&RangeSets, &Quad),
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; QUAD] {
        let mut chunks = std::mem::take(&mut bounds.chunks);
        bounds.found.greatest = [0; QUAD];
        self.choose(quad, how, &mut bounds.found, &mut chunks);
        let mut any = EMPTY;
        if !chunks.is_empty() {
            bounds.rows.set::<W>(&self.layout, &sets.quad(quad.index));
        }
        for chunks in chunks.chunks(W::AT_A_TIME) {
            match *chunks {
                [a, b, c, ..] => self.run_chunks::<W, 3>(how, [a, b, c], bounds, &mut any),
                [a, b] => self.run_chunks::<W, 2>(how, [a, b], bounds, &mut any),
                [a] => self.run_chunks::<W, 1>(how, [a], bounds, &mut any),
                [] => {}
            }
        }
        bounds.chunks = chunks;
        std::array::from_fn(|place| bits::of_block(&any, place) != 0)
    }

    /// Notes at which headings the blocks matter, and the chunks in which any does.
    #[inline(always)]
    fn choose(
        &self,
        quad: &Quad,
        how: How<'_>,
        bounds: &mut HeadingBounds,
        chunks: &mut Vec<usize>,
    ) {
        chunks.clear();
        for (i, chunk) in bounds.chunks.iter_mut().enumerate() {
            chunk.greatest = 0;
            let valid = match how {
                How::Noting(Some((known, least))) if known[i].load(Ordering::Relaxed) < least => 0,
                How::Plain | How::Noting(_) => chunk.valid,
                How::Within((around, place), least) => {
                    let around = &around.chunks[i];
                    let (sums, reach) = (|plane: usize| around.sums[plane], around.reach);
                    let at_least = bits::at_least(self.planes, sums, least, reach);
                    bits::of_block(&at_least, place)
                }
            };
            let valid = |place: usize| {
                if quad.blocks[place].is_some() {
                    valid
                } else {
                    0
                }
            };
            chunk.reach = bits::words(valid);
            if chunk.reach != EMPTY {
                chunks.push(i);
            }
        }
    }

    /// Bounds blocks at the headings of some chunks, and adds to `any` where they reach
    /// what is asked for.
    #[inline(always)]
    fn run_chunks<W: BitWords, const N: usize>(
        &self,
        how: How<'_>,
        places: [usize; N],
        bounds: &mut SetBounds,
        any: &mut Words,
    ) {
        let groups = self.groups();
        let SetBounds {
            found,
            reads,
            carries,
            rows,
            ..
        } = bounds;
        let reader = Reader::new(&self.layout, rows, places);
        let HeadingBounds {
            chunks, greatest, ..
        } = found;
        let mut total = [Several::<W, N>::empty(); bits::PLANES];
        let total = &mut total[..self.planes];
        let mut valid = [W::empty(); N];
        for (valid, place) in valid.iter_mut().zip(places) {
            *valid = W::from_words(&chunks[place].reach);
        }
        let mut reach = valid;
        for added in 1..=groups.len() {
            let left = groups.len() - added;
            // What is around had the groups in this order, and tells what the
            // first ones give: those come last here.
            let within = matches!(how, How::Within(..));
            let group = &groups[if within { left } else { added - 1 }];
            group.add(reader, carries, total);
            *reads += N as u64 * u64::from(group.reads);
            if let How::Within(around, least) = how {
                reach = self.reaching(total, left, (around, places), (least, valid));
                if reach.iter().all(|reach| reach.is_empty()) {
                    break;
                }
            }
            if left > 0 && !matches!(how, How::Plain) {
                for (i, place) in places.into_iter().enumerate() {
                    let after = &mut chunks[place].after[added - 1];
                    for (after, total) in after.iter_mut().zip(&*total) {
                        *after = total.0[i].to_words();
                    }
                }
            }
        }
        for (i, place) in places.into_iter().enumerate() {
            let chunk = &mut chunks[place];
            for (sums, total) in chunk.sums.iter_mut().zip(&*total) {
                *sums = total.0[i].to_words();
            }
            chunk.reach = reach[i].to_words();
            if chunk.reach != EMPTY {
                let most = bits::greatest_of_each(self.planes, |plane| total[plane].0[i], reach[i]);
                *any = any.or(chunk.reach);
                chunk.greatest = most.into_iter().fold(0, u16::max);
                for (greatest, most) in greatest.iter_mut().zip(most) {
                    *greatest = most.max(*greatest);
                }
            }
        }
    }

    /// Where blocks may have so many units, by what was added so far and what the block
    /// around says of the groups that are left.
    #[inline(always)]
    fn reaching<W: BitWords, const N: usize>(
        &self,
        total: &[Several<W, N>],
        left: usize,
        ((around, around_place), places): (Around<'_>, [usize; N]),
        (least, valid): (u16, [W; N]),
    ) -> [W; N] {
        let mut reach = valid;
        for (i, reach) in reach.iter_mut().enumerate() {
            let sums = total.iter().map(|words| words.0[i]);
            let sums = match left {
                0 => sum(sums, |_| W::empty()),
                _ => {
                    let after = &around.chunks[places[i]].after[left - 1];
                    let after = |plane: usize| bits::of_block(&after[plane], around_place);
                    sum(sums, |plane| W::splat(after(plane)))
                }
            };
            *reach = bits::at_least(self.planes, |plane| sums[plane], least, valid[i]);
        }
        reach
    }
}

/// Sums of numbers, as many planes as they have; no sum needs more.
#[inline(always)]
fn sum<W: BitWords>(
    numbers: impl Iterator<Item = W>,
    others: impl Fn(usize) -> W,
) -> [W; bits::PLANES] {
    let mut sums = [W::empty(); bits::PLANES];
    let mut carry = W::empty();
    for (plane, (sum, number)) in sums.iter_mut().zip(numbers).enumerate() {
        (*sum, carry) = number.full_adder(others(plane), carry);
    }
    sums
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bins::Bins;
    use super::super::bits::CHUNK;
    use super::super::index::SearchIndex;
    use super::super::intervals::RangeIntervals;
    use super::super::steps::BinSteps;
    use super::super::task::{Shared, Task};
    use super::super::within::Within;
    use super::*;
    use crate::limits::Limits;
    use crate::reference;
    use crate::testing::{any_grid, any_scan, space_of};
    use crate::votes::CollectConfig;

    proptest! {
        #[test]
        fn no_pose_of_a_block_has_more_votes_than_its_bound(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(45), Just(80)],
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let directions = &space.directions;
            let program = scan.program(&space);
            let bins = Bins::new(directions);
            let steps = BinSteps::new(&bins, directions, grid.width().max(grid.height()) as u16);
            let (intervals, wide) = RangeIntervals::new(&grid, directions, (&bins, &steps));
            let fine = RangeSets::new(&intervals, &wide);
            // Some headings, spread over the turn, are enough to meet any error.
            let fields: Vec<_> = (0..directions.count()).step_by(1 + headings / 8)
                .map(|heading| (heading, reference::field(&grid, &program, &space, heading))).collect();
            for sets in [&fine, &fine.joined()] {
                let mut of_all_sets = Vec::new();
                for instruction_set in InstructionSet::available() {
                    let mut set_program = SetProgram::default();
                    set_program.make(&program, directions, &steps, instruction_set);
                    let all = Within::new(Limits::none(grid.width()));
                    let mut bounds = SetBounds::default();
                    bounds.fit(&set_program, all.headings(directions.count()));
                    let mut found = vec![0; sets.blocks()];
                    let all = |quad| sets.sought(quad, |_| true);
                    set_program.bound_all(sets, (0..sets.quads()).map(all), &mut bounds, |quad, bounds| {
                        for (place, block) in quad.blocks() {
                            found[block] = bounds.greatest(place);
                        }
                    });
                    for (block, &greatest) in found.iter().enumerate() {
                        let (quad, place) = sets.place_of(block);
                        let quad = sets.sought(quad, |other| other == block);
                        let alone = set_program.bound((sets, &quad), &mut bounds);
                        prop_assert_eq!(alone.greatest(place), greatest);
                        let others = (0..QUAD).filter(|&other| other != place);
                        prop_assert!(others.map(|place| alone.greatest(place)).all(|greatest| greatest == 0));
                        prop_assert!(u32::from(greatest) <= program.highest_possible());
                        for (heading, field) in &fields {
                            let most = cells(sets, block, &grid).map(|i| field[i]).max().unwrap_or(0);
                            let at: Vec<_> = alone.at_least(place, most).collect();
                            prop_assert!(at[heading / CHUNK] >> (heading % CHUNK) & 1 == 1, "{} votes", most);
                        }
                    }
                    of_all_sets.push(found);
                }
                prop_assert!(of_all_sets.windows(2).all(|pair| pair[0] == pair[1]));
            }
        }
    }

    proptest! {
        #[test]
        fn what_is_known_of_the_block_around_changes_no_answer(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(80)],
            share in 0.0..=1.0f64,
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let program = scan.program(&space);
            let index = SearchIndex::new(&grid, &space);
            let SearchIndex { coarse, fine, .. } = &index;
            for instruction_set in InstructionSet::available() {
                let mut shared = Shared::default();
                let scan = (&program, &space);
                let task = Task::new(&mut shared, instruction_set, &index, &grid, scan, CollectConfig::default());
                let set_program = &task.programs.sets;
                let [mut around, mut alone] = [(); 2].map(|()| {
                    let mut bounds = SetBounds::default();
                    bounds.fit(set_program, task.headings());
                    bounds
                });
                let mut within = alone.clone();
                for outside in 0..coarse.blocks() {
                    let (outer_quad, outer_place) = coarse.place_of(outside);
                    let outer_quad = coarse.sought(outer_quad, |_| true);
                    let quad = fine.sought(outside, |_| true);
                    // About as many votes as they have, where it matters most.
                    let greatest = set_program.bound((fine, &quad), &mut alone).greatest(0);
                    let least = (f64::from(greatest) * share) as u16;
                    for least in [0, least, greatest, greatest + 1] {
                        let around = set_program.bound((coarse, &outer_quad), &mut around);
                        let around = (around, outer_place);
                        for wanted in 1..1 << QUAD {
                            let places = |block: &usize| quad.blocks.iter().position(|other| other.as_ref() == Some(block));
                            let quad = fine.sought(outside, |block| places(&block).is_some_and(|place| wanted >> place & 1 == 1));
                            let found = set_program.bound_within((fine, &quad), least, around, &mut within);
                            let alone = set_program.bound((fine, &quad), &mut alone);
                            for (place, found) in found.into_iter().enumerate() {
                                let is_sought = quad.blocks[place].is_some();
                                prop_assert_eq!(found, is_sought && alone.greatest(place) >= least);
                                if found {
                                    prop_assert_eq!(within.found.greatest(place), alone.greatest(place));
                                    let at_least: Vec<_> = alone.at_least(place, least).collect();
                                    let at_least = bits::windows(at_least.len(), |chunk| at_least[chunk]);
                                    prop_assert!(within.found.reach(place).eq(at_least));
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// Places of the cells of a block.
    fn cells(
        sets: &RangeSets,
        block: usize,
        grid: &crate::grid::Grid,
    ) -> impl Iterator<Item = usize> {
        let (left, bottom) = (
            block % sets.columns * sets.side,
            block / sets.columns * sets.side,
        );
        let (width, height) = (grid.width(), grid.height());
        let rows = bottom..(bottom + sets.side).min(height);
        rows.flat_map(move |y| (left..(left + sets.side).min(width)).map(move |x| y * width + x))
    }
}
