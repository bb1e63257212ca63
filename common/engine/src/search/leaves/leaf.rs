//! Counting votes, pose by pose, for the 16 cells of a small block at once.
//!
//! The ranges of all cells in a direction are adjacent in memory, so a beam's votes for the
//! whole block take one table look-up for each cell, all of them at once (`tables.rs`).

use super::block_ranges::{BlockRanges, View};
use crate::directions::{Directions, turned};
use crate::program::ScanProgram;
use crate::search::bounds::sectors;
use crate::search::index::bits;
use crate::search::index::intervals::CELLS;
use crate::simd::{Kernel, Set, Simd};
use crate::tables::VoteTable;

/// A scan program laid out for counting in blocks; made again for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct LeafProgram {
    simd: Simd,
    /// Beams by sector, and their bearings.
    order: Vec<usize>,
    bearings: Vec<usize>,
    /// Class of each direction.
    classes: Vec<usize>,
}

/// Votes of a block's cells at a heading.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub(crate) struct Count {
    pub votes: [u16; CELLS],
    /// Most votes of the cells in which poses are searched.
    pub most: u16,
}

impl LeafProgram {
    pub(crate) fn make(&mut self, program: &ScanProgram, directions: &Directions, simd: Simd) {
        self.simd = simd;
        sectors::order(program, &mut self.order);
        let bearings = self.order.iter().map(|&beam| program.bearing(beam));
        self.bearings.clear();
        self.bearings.extend(bearings);
        let classes = directions.all().iter().map(|direction| direction.class);
        self.classes.clear();
        self.classes.extend(classes);
    }

    /// Returns the beams by sector.
    pub(crate) fn order(&self) -> &[usize] {
        &self.order
    }

    /// Adds the votes of a sector of beams to those of the block's cells, at the headings that
    /// bits select from a first one on; each heading has a count. `voting` holds bits for each
    /// beam of all sectors: the headings at which it may vote. The votes of cells that are not
    /// open mean nothing.
    pub(crate) fn add(
        &self,
        scan: &ScanProgram,
        rays: (&mut BlockRanges, &View<'_>),
        (sector, voting): (usize, &[u64]),
        headings: (usize, u64),
        counts: &mut [Count],
    ) {
        let beams = sectors::beams(sector, self.bearings.len());
        self.simd.run(Adding {
            program: self,
            scan,
            rays,
            beams: (beams.start, &voting[beams]),
            headings,
            counts,
        });
    }

    /// Returns the votes of the block's cells at a heading, by the beams that may vote
    /// according to its intervals. The votes of cells that are not open mean nothing.
    pub(crate) fn count(
        &self,
        scan: &ScanProgram,
        block_ranges: &mut BlockRanges,
        view: &View<'_>,
        heading: usize,
    ) -> [u16; CELLS] {
        let mut count = Count::default();
        for sector in 0..sectors::count(self.bearings.len()) {
            let beams = sectors::beams(sector, self.bearings.len());
            let may_vote = |beam: usize| {
                let (direction, table) = self.place(scan, beam, heading);
                let spans = block_ranges.spans(view, direction);
                spans.into_iter().any(|span| table.has_votes_in(span))
            };
            let mut voting = [0; sectors::BEAMS];
            for (voting, beam) in voting.iter_mut().zip(beams.clone()) {
                *voting = u64::from(may_vote(beam));
            }
            self.simd.run(Adding {
                program: self,
                scan,
                rays: (&mut *block_ranges, view),
                beams: (beams.start, &voting[..beams.len()]),
                headings: (heading, 1),
                counts: std::slice::from_mut(&mut count),
            });
        }
        count.votes
    }

    #[inline(always)]
    fn direction(&self, beam: usize, heading: usize) -> usize {
        turned(heading, self.bearings[beam], self.classes.len())
    }

    /// Returns the direction of a beam at a heading, and the beam's table there.
    #[inline(always)]
    fn place<'a>(
        &self,
        scan: &'a ScanProgram,
        beam: usize,
        heading: usize,
    ) -> (usize, VoteTable<'a>) {
        let direction = self.direction(beam, heading);
        let table = scan.table(self.order[beam], self.classes[direction]);
        (direction, table)
    }
}

/// Kernel that adds the votes of beams from a first one on, at headings from a first one
/// on, each with a count.
struct Adding<'a, 'b> {
    program: &'a LeafProgram,
    scan: &'a ScanProgram,
    rays: (&'b mut BlockRanges, &'a View<'a>),
    beams: (usize, &'a [u64]),
    headings: (usize, u64),
    counts: &'b mut [Count],
}

impl Kernel for Adding<'_, '_> {
    type Result = ();

    #[inline(always)]
    fn run<S: Set>(self, set: S) {
        let Adding {
            program,
            scan,
            rays: (block_ranges, view),
            beams: (first_beam, beams),
            headings: (first, headings),
            counts,
        } = self;
        for (beam, voting) in (first_beam..).zip(beams) {
            for lane in bits::ones(headings & voting) {
                block_ranges.compute(view, program.direction(beam, first + lane));
            }
        }
        for lane in bits::ones(headings) {
            let mut votes = counts[lane].votes;
            let voting = beams.iter().enumerate();
            let voting = voting.fold(0, |all, (i, voting)| all | (voting >> lane & 1) << i);
            for beam in bits::ones(voting).map(|i| first_beam + i) {
                let (direction, table) = program.place(scan, beam, first + lane);
                table.add(set, block_ranges.ranges(direction), &mut votes);
            }
            let open = votes.iter().zip(&block_ranges.open);
            let most = open.map(|(votes, open)| votes & open).fold(0, u16::max);
            counts[lane] = Count { votes, most };
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::limits::Limits;
    use crate::reference;
    use crate::search::index::bins::Bins;
    use crate::search::index::intervals::RangeIntervals;
    use crate::search::index::obstacles::Obstacles;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn counts_equal_the_reference_on_every_instruction_set(
            grid in any_grid(), scan in any_scan(), headings in 1u32..12, seed in any::<[usize; 2]>(),
        ) {
            let space = space_of(&grid, headings * 8);
            let directions = &space.directions;
            let program = scan.program(&space);
            let bins = Bins::new(&grid, directions);
            let (intervals, _) = RangeIntervals::of_all(&grid, directions, &bins, InstructionSet::best());
            let obstacles = Obstacles::new(&grid);
            let view = View { grid: &grid, obstacles: &obstacles, bins: &bins, directions };
            let block = seed[0] % (intervals.columns * intervals.rows);
            let heading = seed[1] % directions.count();
            for instruction_set in InstructionSet::available() {
                let mut leaf = LeafProgram::default();
                leaf.make(&program, directions, Simd::new(instruction_set));
                let mut block_ranges = BlockRanges::default();
                block_ranges.prepare(&grid, directions);
                block_ranges.enter((&view, &Limits::none(grid.width())), &intervals, block);
                let mut counts = [Count::default()];
                let all = vec![1; program.beams()];
                for sector in 0..sectors::count(program.beams()) {
                    leaf.add(&program, (&mut block_ranges, &view), (sector, &all), (heading, 1), &mut counts);
                }
                // The same with no more rays than needed.
                block_ranges.enter((&view, &Limits::none(grid.width())), &intervals, block);
                let sparing = leaf.count(&program, &mut block_ranges, &view, heading);
                for (i, counts) in counts[0].votes.into_iter().zip(sparing).enumerate() {
                    let (x, y) = block_ranges.cell(i);
                    if grid.is_open(x as i64, y as i64) {
                        let plain = reference::intensity(&grid, &program, &space, x as i64, y as i64, heading);
                        prop_assert_eq!(counts, (plain, plain), "{:?} {:?}", (x, y), instruction_set);
                    }
                }
            }
        }
    }
}
