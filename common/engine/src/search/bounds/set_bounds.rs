//! Upper bounds of the votes in blocks from their sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share of its
//! votes. If a block sees no range within a window at a heading, the bound there lacks the
//! window's share. The bits of a window are read at the beam's bearing: its whole bytes by
//! where reading starts, the rest by grouping beams and shifting the sums of each group
//! once. The four blocks of a quad are processed together.

use std::sync::atomic::{AtomicU16, Ordering};

use super::group::{Carries, Group};
use super::quad_rows::QuadRows;
use super::set_program::SetProgram;
use crate::search::index::bits;
use crate::search::index::sets::{Quad, RangeSets};
use crate::simd::words::{QUAD, Words};
use crate::simd::{Kernel, Set};

/// Known limits of the blocks of a quad: votes that none of them exceeds in each chunk, and
/// the least votes that matter.
pub(crate) type Known<'a> = (&'a [AtomicU16], u16);

/// Upper bounds of the votes in the blocks of a quad, by heading, with the buffers for finding
/// them.
#[derive(Debug, Clone, Default)]
pub(crate) struct SetBounds {
    /// Number of words read for bounds.
    pub reads: u64,
    /// Unit of all numbers, in votes.
    unit: u16,
    /// Greatest bound of each block, in units.
    greatest: [u16; QUAD],
    chunks: Vec<Chunk>,
    rows: QuadRows,
    carries: Carries,
}

/// Bounds at the headings of a chunk.
#[derive(Debug, Clone)]
struct Chunk {
    /// Greatest bound of each block, in units.
    greatest: [u16; QUAD],
    /// A bit for each heading that is searched.
    valid: u128,
    /// Headings at which each block was bounded and may have as many votes as was asked for.
    reach: Words,
}

impl SetBounds {
    /// Allocates the bounds of a program at some headings, a word of `headings` for each chunk;
    /// drops those of an earlier program.
    pub(crate) fn fit(&mut self, program: &SetProgram, headings: impl Iterator<Item = u128>) {
        self.unit = program.unit;
        self.greatest = [0; QUAD];
        self.chunks.clear();
        self.chunks.extend(headings.map(|valid| Chunk {
            greatest: [0; QUAD],
            valid,
            reach: Words::EMPTY,
        }));
        self.reads = 0;
        self.rows.fit(&program.layout);
        let carries = program.groups.iter().map(Group::carries).max();
        for rows in &mut self.carries {
            rows.resize(carries.unwrap_or(0), Words::EMPTY);
        }
    }

    /// Returns the greatest bound of a block, in votes.
    pub(crate) fn greatest(&self, place: usize) -> u16 {
        self.unit * self.greatest[place]
    }

    /// Returns the greatest bound of a block in each chunk, in votes.
    pub(crate) fn by_chunk(&self, place: usize) -> impl Iterator<Item = u16> {
        let chunks = self.chunks.iter();
        chunks.map(move |chunk| self.unit * chunk.greatest[place])
    }

    /// Returns the headings at which a block reaches the votes asked for, as windows of bits:
    /// the first heading, and a bit for each from there on.
    pub(crate) fn reach(&self, place: usize) -> impl Iterator<Item = (usize, u64)> {
        bits::windows(self.chunks.len(), move |chunk| {
            self.chunks[chunk].reach.block(place)
        })
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
    ) -> &'a SetBounds {
        self.simd.run(Bounding {
            program: self,
            blocks,
            known,
            bounds: &mut *bounds,
        });
        bounds
    }

    /// Bounds the blocks of each quad, and hands the bounds to `take`.
    pub(crate) fn bound_all(
        &self,
        sets: &RangeSets,
        quads: impl Iterator<Item = Quad>,
        bounds: &mut SetBounds,
        mut take: impl FnMut(&Quad, &SetBounds),
    ) {
        for quad in quads {
            take(&quad, self.bound((sets, &quad), None, bounds));
        }
    }

    /// Bounds blocks at the headings of a chunk; stops once none can have `least` units.
    #[inline(always)]
    fn run_chunk<S: Set>(&self, set: S, least: Option<u16>, place: usize, bounds: &mut SetBounds) {
        let SetBounds {
            chunks,
            greatest,
            reads,
            carries,
            rows,
            ..
        } = bounds;
        let chunk = &mut chunks[place];
        let mut total = [Words::EMPTY; bits::PLANES];
        let total = &mut total[..self.planes];
        let valid = chunk.reach;
        let mut reach = valid;
        for (left, group) in self.groups.iter().enumerate().rev() {
            if group.possible == 0 {
                continue;
            }
            group.add(set, (&self.layout, &*rows, place), carries, total);
            *reads += u64::from(group.reads);
            let Some(least) = least else {
                continue;
            };
            let rest: u16 = self.groups[..left].iter().map(|group| group.possible).sum();
            let least = least.saturating_sub(rest);
            reach = bits::at_least(total, least, valid);
            if reach.is_empty() {
                break;
            }
        }
        chunk.reach = reach;
        if !reach.is_empty() {
            chunk.greatest = bits::greatest_of_each(total, reach);
            for (greatest, most) in greatest.iter_mut().zip(chunk.greatest) {
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
        let Bounding {
            program,
            blocks: (sets, quad),
            known,
            bounds,
        } = self;
        let matters = |chunk: usize| {
            known.is_none_or(|(known, least)| known[chunk].load(Ordering::Relaxed) >= least)
        };
        bounds.greatest = [0; QUAD];
        let mut any = false;
        for (i, chunk) in bounds.chunks.iter_mut().enumerate() {
            chunk.greatest = [0; QUAD];
            let valid = if matters(i) { chunk.valid } else { 0 };
            chunk.reach = Words::of(|place| quad.blocks[place].map_or(0, |_| valid));
            any |= chunk.reach != Words::EMPTY;
        }
        if !any {
            return;
        }
        let rows = sets.quad(quad.index);
        bounds.rows.take(set, &program.layout, &rows);
        let least = known.map(|(_, least)| least.div_ceil(program.unit));
        for chunk in 0..bounds.chunks.len() {
            if bounds.chunks[chunk].reach != Words::EMPTY {
                program.run_chunk(set, least, chunk, bounds);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::reference;
    use crate::search::index::SearchIndex;
    use crate::simd::Simd;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn no_pose_of_a_block_has_more_votes_than_its_bound(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(45), Just(80)],
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let directions = &space.directions;
            let program = scan.program(&space);
            let index = SearchIndex::new(&grid, &space);
            // Some headings, spread over the turn, are enough to meet any error.
            let fields: Vec<_> = (0..directions.count()).step_by(1 + headings / 8)
                .map(|heading| (heading, reference::field(&grid, &program, &space, heading))).collect();
            // As many votes as any chunk can have.
            let possible: Vec<_> = (0..headings).map(|_| AtomicU16::new(program.highest_possible() as u16)).collect();
            for sets in [&index.fine, &index.coarse] {
                let mut of_all_sets = Vec::new();
                for instruction_set in InstructionSet::available() {
                    let mut set_program = SetProgram::default();
                    set_program.make(&program, directions, &index.bins, Simd::new(instruction_set));
                    let mut bounds = SetBounds::default();
                    bounds.fit(&set_program, index.headings(directions.count()));
                    let mut found = vec![0; sets.blocks()];
                    let quads = (0..sets.quads()).map(|quad| sets.searched_quad(quad));
                    set_program.bound_all(sets, quads, &mut bounds, |quad, bounds| {
                        for (place, block) in quad.blocks() {
                            found[block] = bounds.greatest(place);
                        }
                    });
                    for (block, &greatest) in found.iter().enumerate() {
                        let (quad, place) = sets.alone(block);
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
