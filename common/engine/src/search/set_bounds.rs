//! Upper bounds of the votes in a block from its sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share
//! of its votes. Where a block sees no range within a window, at a heading, its
//! share is missing there. The bits of a window are read at the beam's bearing:
//! the whole bytes of it by where reading starts, the rest by grouping beams
//! and shifting the sums of each group once.

use super::bits::{self, EMPTY, Planes, Row};
use super::group::{Aligned, Group};
use super::heading_bounds::{Chunk, HeadingBounds};
use super::rows::{BitRow, Several};
use super::set_program::{GROUPS, SetProgram};
use super::sets::RangeSets;
use super::spans::Spans;
use crate::instruction_set::InstructionSet;

/// Blocks that are bounded side by side where there are registers for it.
pub(crate) const SIDE_BY_SIDE: usize = 4;

/// Headings of a chunk: a row less what shifting takes up.
pub(crate) const CHUNK: usize = 504;

/// What the beams from each group on give at most, in votes: more for the first
/// group than they can, and 0 behind the last.
pub(crate) type Rests = [u16; GROUPS + 1];

/// How blocks are bounded.
#[derive(Debug, Clone, Copy)]
enum How<'a> {
    /// At all headings.
    Plain,
    /// The same, and the sums after each group are noted for blocks within.
    Noting,
    /// As blocks within another one, as long as any heading may have so many units.
    Within(&'a HeadingBounds, u16),
}

impl How<'_> {
    /// The block around at the headings of a chunk, and the units that matter.
    #[inline(always)]
    fn within(&self, chunk: usize) -> Option<(&Chunk, u16)> {
        match *self {
            How::Within(around, least) => Some((&around.chunks[chunk], least)),
            How::Plain | How::Noting => None,
        }
    }
}

/// Blocks that are bounded side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Blocks {
    all: [usize; SIDE_BY_SIDE],
    count: usize,
}

impl Blocks {
    /// The next blocks, as many as there are or as are bounded at a time.
    pub(crate) fn take(from: &mut impl Iterator<Item = usize>) -> Self {
        let mut blocks = Blocks::default();
        for (place, block) in blocks.all.iter_mut().zip(from) {
            *place = block;
            blocks.count += 1;
        }
        blocks
    }

    pub(crate) fn as_slice(&self) -> &[usize] {
        &self.all[..self.count]
    }
}

/// Bounds of blocks that are bounded side by side, and room to find them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetBounds {
    /// Those of each block.
    pub blocks: [HeadingBounds; SIDE_BY_SIDE],
    spans: Spans,
    /// Rows carried over to the next plane, and to the one after.
    carries: [Vec<Aligned>; 2],
}

impl SetBounds {
    /// Makes room for the bounds by a program of blocks at some headings, a row a
    /// chunk; nothing is left of what another program had.
    pub(crate) fn fit(&mut self, program: &SetProgram, headings: impl Iterator<Item = Row>) {
        let [first, others @ ..] = &mut self.blocks;
        first.fit(program.unit, headings);
        for block in others {
            block.fit(program.unit, first.chunks.iter().map(|chunk| chunk.valid));
        }
        self.spans.fit(&program.layout, SIDE_BY_SIDE);
        let carries = program.groups().iter().map(Group::windows).max();
        for rows in &mut self.carries {
            rows.resize(SIDE_BY_SIDE * (carries.unwrap_or(0) + 4), Aligned(EMPTY));
        }
    }
}

impl SetProgram {
    /// What the beams from each group on give at most at the headings of a window in a
    /// chunk, by bounds that were found within those of a block around.
    pub(crate) fn rests(
        &self,
        bounds: &HeadingBounds,
        chunk: usize,
        (first, among): (usize, u64),
    ) -> Rests {
        let after = &bounds.chunks[chunk].after;
        let others = self.groups().len().saturating_sub(1);
        let mut rests = Rests::default();
        rests[0] = u16::MAX;
        for group in 1..=others {
            // The last groups were added first.
            let sums = &after[others - group];
            let sums = |plane: usize| bits::window_of(&sums[plane], first);
            rests[group] = self.unit * bits::greatest(self.planes, sums, among);
        }
        rests
    }

    /// Bounds the votes of a block at all headings.
    pub(crate) fn bound<'a>(
        &self,
        (sets, block): (&RangeSets, usize),
        bounds: &'a mut SetBounds,
    ) -> &'a HeadingBounds {
        self.run((sets, &[block]), How::Noting, bounds);
        &bounds.blocks[0]
    }

    /// Bounds those of blocks within one that was bounded by the same beams, up to
    /// [`SIDE_BY_SIDE`] of them. Whether any heading of each may have `least` votes; if
    /// not, its bounds are not finished.
    ///
    /// Only headings matter at which the block around reaches `least`, and what it says
    /// of beams that are still to be added tells sooner whether any does.
    pub(crate) fn bound_within(
        &self,
        blocks: (&RangeSets, &[usize]),
        least: u16,
        around: &HeadingBounds,
        bounds: &mut SetBounds,
    ) -> [bool; SIDE_BY_SIDE] {
        let least = least.div_ceil(self.unit);
        self.run(blocks, How::Within(around, least), bounds)
    }

    /// The greatest bounds of blocks.
    pub(crate) fn bound_all(
        &self,
        sets: &RangeSets,
        mut blocks: impl Iterator<Item = usize>,
        bounds: &mut SetBounds,
        mut take: impl FnMut(usize, u16),
    ) {
        loop {
            let some = Blocks::take(&mut blocks);
            let some = some.as_slice();
            if some.is_empty() {
                break;
            }
            self.run((sets, some), How::Plain, bounds);
            for (&block, bounds) in some.iter().zip(&bounds.blocks) {
                take(block, bounds.greatest());
            }
        }
    }

    fn run(
        &self,
        (sets, blocks): (&RangeSets, &[usize]),
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; SIDE_BY_SIDE] {
        let mut reach = [false; SIDE_BY_SIDE];
        match self.instruction_set {
            // SAFETY: the processor has the instruction set, or it would not be chosen.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe {
                match *blocks {
                    [] => {}
                    [block] => [reach[0]] = self.run_avx512((sets, [block]), 0, how, bounds),
                    [first, ..] => {
                        let four = std::array::from_fn(|i| *blocks.get(i).unwrap_or(&first));
                        reach = self.run_avx512::<SIDE_BY_SIDE>((sets, four), 0, how, bounds);
                    }
                }
            },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe {
                for (i, &block) in blocks.iter().enumerate() {
                    reach[i] = self.run_avx2((sets, block), i, how, bounds);
                }
            },
            _ => {
                for (i, &block) in blocks.iter().enumerate() {
                    [reach[i]] = self.run_with::<Row, 1>((sets, [block]), i, how, bounds);
                }
            }
        }
        reach
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
    fn run_avx512<const N: usize>(
        &self,
        blocks: (&RangeSets, [usize; N]),
        place: usize,
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; N] {
        self.run_with::<super::rows::Avx512, N>(blocks, place, how, bounds)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn run_avx2(
        &self,
        (sets, block): (&RangeSets, usize),
        place: usize,
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> bool {
        let [reaches] = self.run_with::<super::rows::Avx2, 1>((sets, [block]), place, how, bounds);
        reaches
    }

    #[inline(always)]
    fn run_with<R: BitRow, const N: usize>(
        &self,
        (sets, blocks): (&RangeSets, [usize; N]),
        place: usize,
        how: How<'_>,
        bounds: &mut SetBounds,
    ) -> [bool; N] {
        let groups = self.groups();
        let (spans, carries) = (&mut bounds.spans, &mut bounds.carries);
        let bounds = &mut bounds.blocks[place..place + N];
        for (i, &block) in blocks.iter().enumerate() {
            spans.set::<R>(&self.layout, i, sets.block(block));
            bounds[i].greatest = 0;
        }
        let mut any = [false; N];
        for place in 0..bounds[0].chunks.len() {
            let spans = spans.from(place * CHUNK / 8);
            let mut total = [Several::<R, N>::empty(); bits::PLANES];
            let total = &mut total[..self.planes];
            let within = how.within(place);
            let mut valid = R::from_row(&bounds[0].chunks[place].valid);
            if let Some((around, least)) = within {
                let sums = |plane: usize| R::from_row(&around.sums[plane]);
                valid = bits::at_least(self.planes, sums, least, valid);
            }
            let mut reach = [valid; N];
            let mut alive = [!valid.is_empty(); N];
            for added in 1..=groups.len() {
                if alive == [false; N] {
                    break;
                }
                let left = groups.len() - added;
                // What is around had the groups in this order, and tells what the
                // first ones give: those come last here.
                let group = &groups[if within.is_some() { left } else { added - 1 }];
                group.add(spans, carries, total);
                if let Some((around, least)) = within {
                    for i in 0..N {
                        let sums = total.iter().map(|rows| rows.0[i]);
                        let sums = match left {
                            0 => sum(sums, &[EMPTY; bits::PLANES]),
                            _ => sum(sums, &around.after[left - 1]),
                        };
                        reach[i] = bits::at_least(self.planes, |plane| sums[plane], least, valid);
                        alive[i] = !reach[i].is_empty();
                    }
                }
                if left > 0 && !matches!(how, How::Plain) {
                    for (i, bounds) in bounds.iter_mut().enumerate() {
                        let after = &mut bounds.chunks[place].after[added - 1];
                        for (after, total) in after.iter_mut().zip(&*total) {
                            *after = total.0[i].to_row();
                        }
                    }
                }
            }
            for (i, bounds) in bounds.iter_mut().enumerate() {
                let chunk = &mut bounds.chunks[place];
                for (sums, total) in chunk.sums.iter_mut().zip(&*total) {
                    *sums = total.0[i].to_row();
                }
                chunk.reach = reach[i].to_row();
                if alive[i] {
                    let sums = |plane: usize| R::from_row(&chunk.sums[plane]);
                    let greatest = bits::greatest(self.planes, sums, valid);
                    bounds.greatest = bounds.greatest.max(greatest);
                    any[i] = true;
                }
            }
        }
        any
    }
}

/// Sums of numbers, as many planes as they have; no sum needs more.
#[inline(always)]
fn sum<R: BitRow>(numbers: impl Iterator<Item = R>, others: &Planes) -> [R; bits::PLANES] {
    let mut sums = [R::empty(); bits::PLANES];
    let mut carry = R::empty();
    for ((sum, number), other) in sums.iter_mut().zip(numbers).zip(others) {
        (*sum, carry) = number.full_adder(R::from_row(other), carry);
    }
    sums
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bins::Bins;
    use super::super::descent::quarters;
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
            let intervals = RangeIntervals::new(&grid, directions, &bins);
            let fine = RangeSets::new(&intervals, 1);
            // Some headings, spread over the turn, are enough to meet any error.
            let fields: Vec<_> = (0..directions.count()).step_by(1 + headings / 8)
                .map(|heading| (heading, reference::field(&grid, &program, &space, heading))).collect();
            for sets in [&fine, &fine.joined()] {
                let mut of_all_sets = Vec::new();
                for instruction_set in InstructionSet::available() {
                    let mut set_program = SetProgram::default();
                    set_program.make(&program, directions, &steps, sets.shift, instruction_set);
                    let all = Within::new(Limits::none(grid.width()));
                    let mut bounds = SetBounds::default();
                    bounds.fit(&set_program, all.headings(directions.count()));
                    let mut found = Vec::new();
                    set_program.bound_all(sets, 0..sets.blocks(), &mut bounds, |block, greatest| {
                        found.push((block, greatest));
                    });
                    prop_assert!(found.iter().map(|&(block, _)| block).eq(0..sets.blocks()));
                    for &(block, greatest) in &found {
                        let alone = set_program.bound((sets, block), &mut bounds);
                        prop_assert_eq!(alone.greatest(), greatest);
                        prop_assert!(u32::from(greatest) <= program.highest_possible());
                        for (heading, field) in &fields {
                            let most = cells(sets, block, &grid).map(|i| field[i]).max().unwrap_or(0);
                            let at: Vec<Row> = alone.at_least(most).collect();
                            let (chunk, bit) = (heading / CHUNK, heading % CHUNK);
                            prop_assert!(at[chunk][bit / 64] >> (bit % 64) & 1 == 1, "{} votes", most);
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
                let (outer, inner) = (&task.programs.coarse, &task.programs.fine);
                let [mut around, mut alone] = [outer, inner].map(|set_program| {
                    let mut bounds = SetBounds::default();
                    bounds.fit(set_program, task.headings());
                    bounds
                });
                let mut within = alone.clone();
                for outside in 0..coarse.blocks() {
                    let blocks: Vec<_> = quarters(outside, coarse.columns, (fine.columns, fine.rows)).collect();
                    // About as many votes as they have, where it matters most.
                    let greatest = inner.bound((fine, blocks[0]), &mut alone).greatest();
                    let least = (f64::from(greatest) * share) as u16;
                    for least in [0, least, greatest, greatest + 1] {
                        let around = outer.bound((coarse, outside), &mut around);
                        for count in 1..=blocks.len() {
                            let blocks = &blocks[..count];
                            let found = inner.bound_within((fine, blocks), least, around, &mut within);
                            for (place, &block) in blocks.iter().enumerate() {
                                let (alone, within) = (inner.bound((fine, block), &mut alone), &within.blocks[place]);
                                prop_assert_eq!(found[place], alone.greatest() >= least);
                                if found[place] {
                                    prop_assert_eq!(within.greatest(), alone.greatest());
                                    prop_assert!(within.reach().eq(alone.at_least(least)));
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
