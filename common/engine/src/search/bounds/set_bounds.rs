//! Upper bounds of the votes in blocks from their sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share of its
//! votes. If a block sees no range within a window at a heading, the bound there lacks the
//! window's share. The bits of a window are read at the beam's bearing: its whole bytes by
//! where reading starts, the rest by grouping beams and shifting the sums of each group
//! once. The four blocks of a quad are processed together.

use std::sync::atomic::{AtomicU16, Ordering};

use super::group::{Aligned, Carries, Group};
use super::heading_bounds::HeadingBounds;
use super::quad_rows::{QuadRows, Reader};
use super::set_program::SetProgram;
use crate::search::index::bits;
use crate::search::index::sets::{Quad, RangeSets};
use crate::simd::words::{BitWords, EMPTY, QUAD};
use crate::simd::{Kernel, Set};

/// Known limits of the blocks of a quad: votes that none of them exceeds in each chunk, and
/// the least votes that matter.
pub(crate) type Known<'a> = (&'a [AtomicU16], u16);

/// Bounds of the blocks of a quad, with the buffers for finding them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetBounds {
    pub found: HeadingBounds,
    /// Number of words read since [`SetBounds::fit`].
    pub reads: u64,
    /// Chunks in which any heading matters.
    chunks: Vec<usize>,
    rows: QuadRows,
    carries: Carries,
}

impl SetBounds {
    /// Allocates the bounds of a program at some headings, a word of `headings` for each chunk;
    /// drops those of an earlier program.
    pub(crate) fn fit(&mut self, program: &SetProgram, headings: impl Iterator<Item = u128>) {
        self.found.fit(program.unit, headings);
        self.reads = 0;
        self.rows.fit(&program.layout);
        let carries = program.groups().iter().map(Group::carries).max();
        for rows in &mut self.carries {
            rows.resize(carries.unwrap_or(0), Aligned(EMPTY));
        }
    }
}

impl SetProgram {
    /// Bounds the votes of blocks at all headings or, with `known`, at those where any may have
    /// as many as matter. Then the bounds at other headings are left unfinished.
    pub(crate) fn bound<'a>(
        &self,
        blocks: (&RangeSets, &Quad),
        known: Option<Known<'_>>,
        bounds: &'a mut SetBounds,
    ) -> &'a HeadingBounds {
        self.simd.run(Bounding {
            program: self,
            blocks,
            known,
            bounds: &mut *bounds,
        });
        &bounds.found
    }

    /// Bounds the blocks of each quad, and hands the bounds to `take`.
    pub(crate) fn bound_all(
        &self,
        sets: &RangeSets,
        quads: impl Iterator<Item = Quad>,
        bounds: &mut SetBounds,
        mut take: impl FnMut(&Quad, &HeadingBounds),
    ) {
        for quad in quads {
            take(&quad, self.bound((sets, &quad), None, bounds));
        }
    }

    #[inline(always)]
    fn run<S: Set>(
        &self,
        set: S,
        (sets, quad): (&RangeSets, &Quad),
        known: Option<Known<'_>>,
        bounds: &mut SetBounds,
    ) {
        let mut chunks = std::mem::take(&mut bounds.chunks);
        bounds.found.greatest = [0; QUAD];
        self.choose(quad, known, &mut bounds.found, &mut chunks);
        if !chunks.is_empty() {
            let rows = sets.quad(quad.index);
            bounds.rows.take::<S::Words>(set, &self.layout, &rows);
        }
        let least = known.map(|(_, least)| least.div_ceil(self.unit));
        for &chunk in &chunks {
            self.run_chunk(set, least, chunk, bounds);
        }
        bounds.chunks = chunks;
    }

    /// Chooses the headings at which the blocks are bounded, and the chunks that hold any.
    #[inline(always)]
    fn choose(
        &self,
        quad: &Quad,
        known: Option<Known<'_>>,
        bounds: &mut HeadingBounds,
        chunks: &mut Vec<usize>,
    ) {
        let matters = |chunk: usize| {
            known.is_none_or(|(known, least)| known[chunk].load(Ordering::Relaxed) >= least)
        };
        chunks.clear();
        for (i, chunk) in bounds.chunks.iter_mut().enumerate() {
            chunk.greatest = [0; QUAD];
            let valid = if matters(i) { chunk.valid } else { 0 };
            chunk.reach = bits::words(|place| quad.blocks[place].map_or(0, |_| valid));
            if chunk.reach != EMPTY {
                chunks.push(i);
            }
        }
    }

    /// Bounds blocks at the headings of a chunk; stops once none can have `least` units.
    #[inline(always)]
    fn run_chunk<S: Set>(&self, set: S, least: Option<u16>, place: usize, bounds: &mut SetBounds) {
        let groups = self.groups();
        let SetBounds {
            found,
            reads,
            carries,
            rows,
            ..
        } = bounds;
        let reader = Reader::new(&self.layout, rows, place);
        let chunk = &mut found.chunks[place];
        let mut total = [S::Words::empty(set); bits::PLANES];
        let total = &mut total[..self.planes];
        let valid = S::Words::from_words(set, &chunk.reach);
        let mut reach = valid;
        for left in (0..groups.len()).rev() {
            groups[left].add(set, reader, carries, total);
            *reads += u64::from(groups[left].reads);
            let Some(least) = least else {
                continue;
            };
            let rest: u16 = groups[..left].iter().map(|group| group.possible).sum();
            let least = least.saturating_sub(rest);
            reach = bits::at_least(set, self.planes, |plane| total[plane], least, valid);
            if reach.is_empty() {
                break;
            }
        }
        chunk.reach = reach.to_words();
        if !reach.is_empty() {
            chunk.greatest = bits::greatest_of_each(set, self.planes, |plane| total[plane], reach);
            for (greatest, most) in found.greatest.iter_mut().zip(chunk.greatest) {
                *greatest = most.max(*greatest);
            }
        }
    }
}

/// Kernel that bounds the blocks of a quad.
struct Bounding<'a, 'b> {
    program: &'a SetProgram,
    blocks: (&'a RangeSets, &'a Quad),
    known: Option<Known<'a>>,
    bounds: &'b mut SetBounds,
}

impl Kernel for Bounding<'_, '_> {
    type Result = ();

    #[inline(always)]
    fn run<S: Set>(self, set: S) {
        self.program.run(set, self.blocks, self.known, self.bounds);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::limits::Limits;
    use crate::reference;
    use crate::search::index::SearchIndex;
    use crate::search::index::bins::Bins;
    use crate::search::index::intervals::RangeIntervals;
    use crate::search::index::steps::BinSteps;
    use crate::search::index::within::Within;
    use crate::search::task::lead::Lead;
    use crate::search::task::{Shared, Task};
    use crate::simd::Simd;
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
            let (intervals, wide) = RangeIntervals::of_all(&grid, directions, (&bins, &steps));
            let fine = RangeSets::new(&intervals, &wide);
            // Some headings, spread over the turn, are enough to meet any error.
            let fields: Vec<_> = (0..directions.count()).step_by(1 + headings / 8)
                .map(|heading| (heading, reference::field(&grid, &program, &space, heading))).collect();
            // As many votes as any chunk can have.
            let possible: Vec<_> = (0..headings).map(|_| AtomicU16::new(program.highest_possible() as u16)).collect();
            for sets in [&fine, &fine.joined()] {
                let mut of_all_sets = Vec::new();
                for instruction_set in InstructionSet::available() {
                    let mut set_program = SetProgram::default();
                    set_program.make(&program, directions, &steps, Simd::new(instruction_set));
                    let all = Within::new(Limits::none(grid.width()), &grid);
                    let mut bounds = SetBounds::default();
                    bounds.fit(&set_program, all.headings(directions.count()));
                    let mut found = vec![0; sets.blocks()];
                    let all = |quad| sets.searched(quad, |_| true);
                    set_program.bound_all(sets, (0..sets.quads()).map(all), &mut bounds, |quad, bounds| {
                        for (place, block) in quad.blocks() {
                            found[block] = bounds.greatest(place);
                        }
                    });
                    for (block, &greatest) in found.iter().enumerate() {
                        let (quad, place) = sets.place_of(block);
                        let quad = sets.searched(quad, |other| other == block);
                        let alone = set_program.bound((sets, &quad), None, &mut bounds);
                        prop_assert_eq!(alone.greatest(place), greatest);
                        let others = (0..QUAD).filter(|&other| other != place);
                        prop_assert!(others.map(|place| alone.greatest(place)).all(|greatest| greatest == 0));
                        prop_assert!(u32::from(greatest) <= program.highest_possible());
                        for &(heading, ref field) in &fields {
                            let most = cells(sets, block, &grid).map(|i| field[i]).max().unwrap_or(0);
                            let known = Some((&possible[..], most));
                            let mut reach = set_program.bound((sets, &quad), known, &mut bounds).reach(place);
                            let is_held = |(first, among): (usize, u64)| {
                                (first..first + 64).contains(&heading) && among >> (heading - first) & 1 == 1
                            };
                            prop_assert!(reach.any(is_held), "{} votes", most);
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
                let (scan, lead) = ((&program, &space), Lead::default());
                let task = Task::new(&mut shared, Simd::new(instruction_set), &index, &grid, scan, (CollectConfig::default(), &lead));
                let set_program = &task.programs.sets;
                let [mut around, mut alone] = [(); 2].map(|()| {
                    let mut bounds = SetBounds::default();
                    bounds.fit(set_program, task.headings());
                    bounds
                });
                let (mut found, mut plain) = (alone.clone(), alone.clone());
                // As many votes as any chunk can have.
                let possible: Vec<_> = (0..headings).map(|_| AtomicU16::new(program.highest_possible() as u16)).collect();
                for outside in 0..coarse.blocks() {
                    let (outer_quad, outer_place) = coarse.place_of(outside);
                    let outer_quad = coarse.searched(outer_quad, |_| true);
                    let around = set_program.bound((coarse, &outer_quad), None, &mut around);
                    let known: Vec<_> = around.by_chunk(outer_place).map(AtomicU16::new).collect();
                    let quad = fine.searched(outside, |_| true);
                    // About as many votes as they have, where it matters most.
                    let greatest = set_program.bound((fine, &quad), None, &mut alone).greatest(0);
                    let least = (f64::from(greatest) * share) as u16;
                    for least in [0, least, greatest, greatest + 1] {
                        for wanted in 1..1 << QUAD {
                            let places = |block: &usize| quad.blocks.iter().position(|other| other.as_ref() == Some(block));
                            let quad = fine.searched(outside, |block| places(&block).is_some_and(|place| wanted >> place & 1 == 1));
                            let found = set_program.bound((fine, &quad), Some((&known, least)), &mut found);
                            let plain = set_program.bound((fine, &quad), Some((&possible, least)), &mut plain);
                            let alone = set_program.bound((fine, &quad), None, &mut alone);
                            for place in 0..QUAD {
                                let is_searched = quad.blocks[place].is_some();
                                let reaches = is_searched && alone.greatest(place) >= least;
                                prop_assert_eq!(found.reach(place).next().is_some(), reaches);
                                prop_assert!(found.reach(place).eq(plain.reach(place)));
                                let greatest = if reaches { alone.greatest(place) } else { 0 };
                                prop_assert_eq!([found, plain].map(|bounds| bounds.greatest(place)), [greatest; 2]);
                            }
                        }
                    }
                }
            }
        }
    }

    /// Returns the indices of a block's cells in the grid.
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
