//! Upper bounds of the votes in a block from its sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share
//! of its votes. Where a block sees no range within a window, at a heading, its
//! share is missing there. The bits of a window are read at the beam's bearing:
//! the whole bytes of it by where reading starts, the rest by grouping beams
//! and shifting the sums of each group once.

use std::ops::Range;

use super::bits::{self, EMPTY, Planes, Row};
use super::group::{Aligned, Group};
use super::rows::BitRow;
use super::sets::RangeSets;
use super::spans::{SpanLayout, Spans};
use super::steps::BinSteps;
use crate::directions::Directions;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;

/// Headings of a chunk: a row less what shifting takes up.
pub(crate) const CHUNK: usize = 504;

/// A scan program laid out for bounds from sets; made anew for each scan.
#[derive(Debug, Clone)]
pub(crate) struct SetProgram {
    instruction_set: InstructionSet,
    /// Votes are counted in this unit, of which all peaks are multiples.
    unit: u16,
    /// Planes that hold all sums.
    planes: usize,
    /// One for each rest; those that have any beams come first.
    groups: [Group; 8],
    /// How many of them have.
    used: usize,
    layout: SpanLayout,
}

/// Bounds of a block for all headings, and room to find them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetBounds {
    unit: u16,
    /// Sums in units, and which headings matter.
    chunks: Vec<(Planes, Row)>,
    spans: Spans,
    /// Rows carried over to the next plane, and to the one after.
    carries: [Vec<Aligned>; 2],
}

impl SetBounds {
    /// Makes room for the bounds by a program of a block at some headings, a row
    /// a chunk; nothing is left of what another program had.
    pub(crate) fn fit(&mut self, program: &SetProgram, headings: impl Iterator<Item = Row>) {
        self.unit = program.unit;
        self.chunks.clear();
        let chunks = headings.map(|headings| ([EMPTY; bits::PLANES], headings));
        self.chunks.extend(chunks);
        self.spans.fit(&program.layout);
        let carries = program.groups().iter().map(Group::windows).max();
        for rows in &mut self.carries {
            rows.resize(carries.unwrap_or(0) + 4, Aligned(EMPTY));
        }
    }

    /// The greatest bound.
    pub(crate) fn greatest(&self) -> u16 {
        let greatest = |(sums, valid): &(Planes, Row)| bits::greatest(sums, *valid);
        let units = self.chunks.iter().map(greatest).max();
        self.unit * units.unwrap_or(0)
    }

    /// For each chunk, the headings at which this block and the one around it
    /// have a bound of at least `least`.
    pub(crate) fn at_least(&self, least: u16, around: &SetBounds) -> impl Iterator<Item = Row> {
        let (here_least, around_least) = (least.div_ceil(self.unit), least.div_ceil(around.unit));
        let chunks = self.chunks.iter().zip(&around.chunks);
        chunks.map(move |(here, around)| {
            let around = bits::at_least(&around.0, around_least, around.1);
            bits::at_least(&here.0, here_least, around)
        })
    }
}

impl Default for SetProgram {
    fn default() -> Self {
        SetProgram {
            instruction_set: InstructionSet::Portable,
            unit: 1,
            planes: 0,
            groups: [0, 1, 2, 3, 4, 5, 6, 7].map(Group::new),
            used: 0,
            layout: SpanLayout::default(),
        }
    }
}

impl SetProgram {
    /// Lays out a program for sets of which each row stands for `1 << shift`
    /// bins.
    pub(crate) fn make(
        &mut self,
        program: &ScanProgram,
        directions: &Directions,
        steps: &BinSteps,
        shift: u32,
        instruction_set: InstructionSet,
    ) {
        let peaks = (0..program.beams()).map(|beam| program.peak(beam));
        let unit = peaks.reduce(greatest_common_divisor).unwrap_or(1).max(1);
        (self.instruction_set, self.unit) = (instruction_set, unit);
        self.layout.start(directions.count(), shift);
        self.groups.sort_unstable_by_key(Group::shift);
        self.groups.iter_mut().for_each(Group::clear);
        for beam in 0..program.beams() {
            let bearing = program.bearing(beam);
            for (plane, rows) in windows(program, beam, directions, steps, shift, unit) {
                let window = self.layout.window(rows, bearing / 8);
                self.groups[bearing % 8].push(plane, window);
            }
        }
        self.groups
            .sort_unstable_by_key(|group| (group.possible == 0, group.shift()));
        self.used = self.groups.partition_point(|group| group.possible > 0);
        let possible: u16 = self.groups.iter().map(|group| group.possible).sum();
        self.planes = possible
            .checked_ilog2()
            .map_or(0, |plane| plane as usize + 1);
    }

    /// Those that have beams.
    fn groups(&self) -> &[Group] {
        &self.groups[..self.used]
    }

    /// A quick bound of all votes in a block, from one group of beams, and what
    /// the block promises if the others agree as much.
    pub(crate) fn rough(
        &self,
        sets: &RangeSets,
        block: usize,
        bounds: &mut SetBounds,
    ) -> (u16, u16) {
        let Some((first, others)) = self.groups().split_first() else {
            return (0, 0);
        };
        self.run(&self.groups[..1], sets, block, 0, bounds);
        let here = bounds.greatest() / self.unit;
        let rest: u16 = others.iter().map(|group| group.possible).sum();
        let promise =
            u32::from(here) * u32::from(first.possible + rest) / u32::from(first.possible);
        (self.unit * (here + rest), self.unit * promise as u16)
    }

    /// Bounds the votes of a block at all headings. Whether any heading may
    /// have `least` votes; if not, the bounds are not finished.
    pub(crate) fn bound(
        &self,
        sets: &RangeSets,
        block: usize,
        least: u16,
        bounds: &mut SetBounds,
    ) -> bool {
        let least = least.div_ceil(self.unit);
        self.run(self.groups(), sets, block, least, bounds)
    }

    fn run(
        &self,
        groups: &[Group],
        sets: &RangeSets,
        block: usize,
        least: u16,
        bounds: &mut SetBounds,
    ) -> bool {
        match self.instruction_set {
            // SAFETY: the processor has the instruction set, or it would not be chosen.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe {
                self.run_avx512(groups, sets, block, least, bounds)
            },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { self.run_avx2(groups, sets, block, least, bounds) },
            _ => self.run_with::<Row>(groups, sets, block, least, bounds),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
    fn run_avx512(
        &self,
        groups: &[Group],
        sets: &RangeSets,
        block: usize,
        least: u16,
        bounds: &mut SetBounds,
    ) -> bool {
        self.run_with::<super::rows::Avx512>(groups, sets, block, least, bounds)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn run_avx2(
        &self,
        groups: &[Group],
        sets: &RangeSets,
        block: usize,
        least: u16,
        bounds: &mut SetBounds,
    ) -> bool {
        self.run_with::<super::rows::Avx2>(groups, sets, block, least, bounds)
    }

    #[inline(always)]
    fn run_with<R: BitRow>(
        &self,
        groups: &[Group],
        sets: &RangeSets,
        block: usize,
        least: u16,
        bounds: &mut SetBounds,
    ) -> bool {
        bounds.spans.set::<R>(&self.layout, sets.block(block));
        let mut any = false;
        for (chunk, (sums, valid)) in bounds.chunks.iter_mut().enumerate() {
            let spans = bounds.spans.from(chunk * CHUNK / 8);
            let valid = R::from_row(valid);
            let mut rest: u16 = groups.iter().map(|group| group.possible).sum();
            let mut total = [R::empty(); bits::PLANES];
            let total = &mut total[..self.planes];
            let mut alive = any_reaches(total, least.saturating_sub(rest), valid);
            for group in groups {
                group.add(spans, &mut bounds.carries, total);
                rest -= group.possible;
                alive = any_reaches(total, least.saturating_sub(rest), valid);
                if !alive {
                    break;
                }
            }
            for (sums, total) in sums.iter_mut().zip(total) {
                *sums = total.to_row();
            }
            any |= alive;
        }
        any
    }
}

/// Whether any of the sums that `among` selects is at least `least`.
#[inline(always)]
fn any_reaches<R: BitRow>(sums: &[R], least: u16, among: R) -> bool {
    if usize::from(least) >> sums.len() != 0 {
        return false;
    }
    // Equal so far from the highest plane down, or greater already.
    let (mut equal, mut greater) = (among, R::empty());
    for (plane, sum) in sums.iter().enumerate().rev() {
        if least >> plane & 1 == 1 {
            equal = equal.and(*sum);
        } else {
            greater = greater.or(equal.and(*sum));
            equal = equal.without(*sum);
        }
    }
    !greater.or(equal).is_empty()
}

fn greatest_common_divisor(a: u16, b: u16) -> u16 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

/// Windows of rows of sets that cover the taper of a beam in all classes of
/// directions, each with the plane of its share: one for each binary digit of
/// the peak, that of the highest for the whole taper.
fn windows(
    program: &ScanProgram,
    beam: usize,
    directions: &Directions,
    steps: &BinSteps,
    shift: u32,
    unit: u16,
) -> impl Iterator<Item = (usize, Range<usize>)> {
    let peak = program.peak(beam) / unit;
    let planes = (0..bits::PLANES).rev();
    planes
        .filter(move |plane| peak >> plane & 1 == 1)
        .filter_map(move |plane| {
            // Windows of higher planes cover votes up to here.
            let below = unit * (peak >> plane >> 1 << plane << 1);
            let rows = (0..directions.classes()).filter_map(|class| {
                let taper = program.taper(beam, class);
                let votes = |&votes: &u8| u16::from(votes) > below;
                let last = taper.profile.partition_point(votes).checked_sub(1)? as u16;
                let row = |at| usize::from(steps.bin(class, at) >> shift);
                Some((
                    row(taper.centre.saturating_sub(last)),
                    row(taper.centre + last) + 1,
                ))
            });
            let (first, end) = rows.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
            Some((plane, first..end))
        })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bins::Bins;
    use super::super::intervals::RangeIntervals;
    use super::super::within::Within;
    use super::*;
    use crate::limits::Limits;
    use crate::reference;
    use crate::testing::{any_grid, any_scan, space_of};

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
                    for block in 0..sets.blocks() {
                        let (rough, _) = set_program.rough(sets, block, &mut bounds);
                        prop_assert!(set_program.bound(sets, block, 0, &mut bounds));
                        prop_assert!(bounds.greatest() <= rough);
                        prop_assert!(u32::from(bounds.greatest()) <= program.highest_possible());
                        let greatest = bounds.greatest();
                        for (heading, field) in &fields {
                            let most = cells(sets, block, &grid).map(|i| field[i]).max().unwrap_or(0);
                            let at: Vec<Row> = bounds.at_least(most, &bounds).collect();
                            let (chunk, bit) = (heading / CHUNK, heading % CHUNK);
                            prop_assert!(at[chunk][bit / 64] >> (bit % 64) & 1 == 1, "{} votes", most);
                        }
                        // Stopping early never loses a heading that reaches the floor.
                        prop_assert!(set_program.bound(sets, block, greatest, &mut bounds));
                        prop_assert!(!set_program.bound(sets, block, greatest + 1, &mut bounds));
                        found.push((rough, greatest));
                    }
                    of_all_sets.push(found);
                }
                prop_assert!(of_all_sets.windows(2).all(|pair| pair[0] == pair[1]));
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
