//! An index as sections of plain bytes, for callers that keep it between runs.
//!
//! Sections hold all that takes long to make. Bytes that are read back are not trusted: an
//! index is searched only after a check that all places at which a search reads are within
//! it. The caller must make sure that the index is that of the map, see
//! [`IndexKey`](super::IndexKey).

use bytemuck::{cast_slice, cast_slice_mut};

use super::SearchIndex;
use super::bins::Bins;
use super::intervals::RangeIntervals;
use super::obstacles::Obstacles;
use super::sets::RangeSets;
use crate::grid::{CellSet, Grid};
use crate::limits::Limits;
use crate::space::Space;

/// Number of sections of an index.
pub const SECTIONS: usize = 15;

/// Names of the sections, in their order.
const NAMES: [&str; SECTIONS] = [
    "cells",
    "headings",
    "blocks of 4 x 4",
    "blocks of 8 x 8",
    "blocks of 16 x 16",
    "intervals",
    "starts of fine sets",
    "masks of fine sets",
    "bytes of fine sets",
    "starts of coarse sets",
    "masks of coarse sets",
    "bytes of coarse sets",
    "obstacles along x",
    "obstacles along y",
    "clearance",
];

/// Error of sections that cannot be those of an index of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SectionError {
    /// No index of the map has this many bytes in the section.
    #[error("section {section:?} has {bytes} bytes, which no index of the map has")]
    Length {
        /// Name of the section.
        section: &'static str,
        /// Length of the section in bytes.
        bytes: u64,
    },
    /// The index takes more bytes than are allowed.
    #[error("the index takes {bytes} bytes, and the memory limit allows {limit}")]
    Memory {
        /// Bytes of the index.
        bytes: u64,
        /// Largest number of bytes allowed.
        limit: u64,
    },
    /// The contents of a section do not fit the others.
    #[error("what section {0:?} holds does not fit the others")]
    Content(&'static str),
}

/// An index of a map whose sections are being filled in.
#[derive(Debug)]
pub struct UncheckedIndex(SearchIndex);

impl SearchIndex {
    /// Version of the sections, counted up whenever the same map leads to other ones.
    pub const VERSION: u32 = 1;

    /// Returns the bytes of all sections, in their order.
    pub fn sections(&self) -> [&[u8]; SECTIONS] {
        let sets = self.limits.sets();
        let [cells, headings] = sets.map(|set| set.map_or(&[][..], words));
        let (small_blocks, packed) = self.intervals.parts();
        let [fine_blocks, a, b, c] = self.fine.parts();
        let [coarse_blocks, d, e, f] = self.coarse.parts();
        let ([along_x, along_y], clearance) = self.obstacles.parts();
        [
            cells,
            headings,
            words(small_blocks),
            fine_blocks,
            coarse_blocks,
            packed,
            a,
            b,
            c,
            d,
            e,
            f,
            cast_slice(along_x),
            cast_slice(along_y),
            clearance,
        ]
    }
}

impl UncheckedIndex {
    /// Allocates buffers for sections of these lengths, in bytes, if an index of the map can
    /// have them.
    pub(crate) fn new(
        lengths: [u64; SECTIONS],
        grid: &Grid,
        space: &Space,
    ) -> Result<Self, SectionError> {
        let impossible = |section: usize| SectionError::Length {
            section: NAMES[section],
            bytes: lengths[section],
        };
        let length =
            |section: usize| usize::try_from(lengths[section]).map_err(|_| impossible(section));
        let lengths_from =
            |first: usize| Ok([length(first)?, length(first + 1)?, length(first + 2)?]);
        let directions = &space.directions;
        let by = [lengths[0] > 0, lengths[1] > 0];
        let intervals = RangeIntervals::unfilled(grid, directions, length(5)?);
        let sets = |side, first| {
            let sets = RangeSets::unfilled(side, grid, directions, lengths_from(first)?);
            sets.ok_or_else(|| impossible(first))
        };
        let mut unchecked = UncheckedIndex(SearchIndex {
            bins: Bins::new(grid, directions),
            intervals: intervals.ok_or_else(|| impossible(5))?,
            fine: sets(8, 6)?,
            coarse: sets(16, 9)?,
            obstacles: Obstacles::unfilled(grid),
            limits: Limits::unfilled(grid, directions, by),
            sweeps: Default::default(),
        });
        let sections = unchecked.sections_mut();
        let mut sections = sections
            .iter()
            .zip(lengths)
            .map(|(section, length)| section.len() as u64 == length);
        match sections.position(|is_right| !is_right) {
            Some(section) => Err(impossible(section)),
            None => Ok(unchecked),
        }
    }

    /// Returns all sections, to be filled in.
    pub fn sections_mut(&mut self) -> [&mut [u8]; SECTIONS] {
        let SearchIndex {
            intervals,
            fine,
            coarse,
            obstacles,
            limits,
            ..
        } = &mut self.0;
        let sets = limits.sets_mut();
        let [cells, headings] = sets.map(|set| set.map_or(&mut [][..], words_mut));
        let (small_blocks, packed) = intervals.parts_mut();
        let [fine_blocks, a, b, c] = fine.parts_mut();
        let [coarse_blocks, d, e, f] = coarse.parts_mut();
        let ([along_x, along_y], clearance) = obstacles.parts_mut();
        [
            cells,
            headings,
            words_mut(small_blocks),
            fine_blocks,
            coarse_blocks,
            packed,
            a,
            b,
            c,
            d,
            e,
            f,
            cast_slice_mut(along_x),
            cast_slice_mut(along_y),
            clearance,
        ]
    }

    /// Returns the index, if no search can read beyond what was filled in.
    ///
    /// # Errors
    /// Names the section that does not fit.
    pub fn check(mut self) -> Result<SearchIndex, SectionError> {
        let SearchIndex {
            intervals,
            fine,
            coarse,
            ..
        } = &mut self.0;
        for (is_sound, section) in [
            (intervals.number(), 5),
            (fine.are_sound(), 6),
            (coarse.are_sound(), 9),
        ] {
            if !is_sound {
                return Err(SectionError::Content(NAMES[section]));
            }
        }
        Ok(self.0)
    }
}

fn words(set: &CellSet) -> &[u8] {
    cast_slice(set.words())
}

fn words_mut(set: &mut CellSet) -> &mut [u8] {
    cast_slice_mut(set.words_mut())
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;
    use twox_hash::XxHash3_64;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::testing::{any_limited_grid, any_scan, grid_of, space_of};
    use crate::votes::CollectConfig;

    fn lengths(index: &SearchIndex) -> [u64; SECTIONS] {
        index.sections().map(|section| section.len() as u64)
    }

    /// Makes an index from the sections of another one, after `change`.
    fn taken_back(
        index: &SearchIndex,
        (grid, space): (&Grid, &Space),
        change: impl FnOnce(&mut [&mut [u8]; SECTIONS]),
    ) -> Result<SearchIndex, SectionError> {
        let mut unchecked = UncheckedIndex::new(lengths(index), grid, space)?;
        let mut sections = unchecked.sections_mut();
        for (to, from) in sections.iter_mut().zip(index.sections()) {
            to.copy_from_slice(from);
        }
        change(&mut sections);
        unchecked.check()
    }

    proptest! {
        #[test]
        fn what_is_taken_back_equals_what_was_made(
            (grid, limits, headings) in any_limited_grid(8), scan in any_scan(), candidates in 0u32..9,
        ) {
            let space = space_of(&grid, headings);
            let made = SearchIndex::within(&grid, &space, limits);
            let back = taken_back(&made, (&grid, &space), |_| ()).unwrap();
            prop_assert_eq!(back.sections(), made.sections());
            prop_assert_eq!(back.limits(), made.limits());
            let program = scan.program(&space);
            let config = CollectConfig { candidates, floor_share: 0.6, ..CollectConfig::default() };
            for set in InstructionSet::available() {
                let [back, made] = [&back, &made].map(|index| {
                    index.search((set, 1), &grid, (&program, &space), config)
                });
                prop_assert_eq!(back, made);
            }
        }

        // Checksums find what went wrong on a disk; this is for what they cannot know.
        #[test]
        fn sections_of_anything_are_refused_or_searched_without_harm(
            (grid, limits, headings) in any_limited_grid(8), scan in any_scan(),
            changes in vec((0..SECTIONS, any::<usize>(), any::<u8>()), 1..20),
        ) {
            let space = space_of(&grid, headings);
            let made = SearchIndex::within(&grid, &space, limits);
            let back = taken_back(&made, (&grid, &space), |sections| {
                for (section, place, byte) in changes {
                    let section = &mut sections[section];
                    if let Some(place) = place.checked_rem(section.len()) {
                        section[place] = byte;
                    }
                }
            });
            let Ok(back) = back else { return Ok(()) };
            let program = scan.program(&space);
            for set in InstructionSet::available() {
                let _ = back.search((set, 1), &grid, (&program, &space), CollectConfig::default());
            }
        }

        #[test]
        fn lengths_that_no_index_of_the_map_has_are_refused(
            (grid, limits, headings) in any_limited_grid(8), section in 0..SECTIONS, by in 1u64..99,
        ) {
            let space = space_of(&grid, headings);
            let made = SearchIndex::within(&grid, &space, limits);
            let mut lengths = lengths(&made);
            for length in [lengths[section] + by, u64::MAX - by] {
                lengths[section] = length;
                let refused = UncheckedIndex::new(lengths, &grid, &space).map(|_| ());
                // Lengths that depend on the cells are known only once these were read.
                let depends = matches!(section, 5 | 7 | 8 | 10 | 11);
                // Cells or headings that were not limited, and of which there are as many
                // as the map has, are those of an index of other limits.
                let whole = [grid.cells().len(), headings as usize];
                let is_whole = whole.get(section).is_some_and(|all| {
                    length == 8 * all.div_ceil(u64::BITS as usize) as u64
                });
                prop_assert!(refused.is_err() != is_whole || depends && length < 1 << 30);
            }
        }
    }

    /// Rooms and clutter.
    fn world() -> (Grid, Space) {
        let grid = grid_of((150, 90), |x, y, noise| {
            let is_wall = x % 40 == 0 && y % 40 > 8 || y % 40 == 0 && x % 40 > 8;
            100 * u8::from(is_wall || x > 100 && noise < 20)
        });
        let space = space_of(&grid, 360);
        (grid, space)
    }

    /// If this fails, files that were written before would be read as what they are not:
    /// count up [`SearchIndex::VERSION`], then write the new hash here.
    #[test]
    fn a_version_always_has_the_same_sections() {
        let (grid, space) = world();
        let index = SearchIndex::new(&grid, &space);
        let hashes = index.sections().map(XxHash3_64::oneshot);
        let hash = XxHash3_64::oneshot(bytemuck::cast_slice(&hashes));
        assert_eq!((SearchIndex::VERSION, hash), (1, 1_150_297_720_418_113_986));
    }

    #[test]
    fn blocks_that_are_more_than_are_packed_are_refused() {
        let (grid, space) = world();
        let index = SearchIndex::new(&grid, &space);
        let back = |section: usize, place: usize, byte: u8| {
            taken_back(&index, (&grid, &space), |sections| {
                sections[section][place] ^= byte;
            })
            .map(|_| ())
        };
        assert_eq!(back(2, 7, 128), Err(SectionError::Content("intervals")));
        assert_eq!(
            back(7, 0, 1),
            Err(SectionError::Content("starts of fine sets"))
        );
        assert_eq!(
            back(9, 8, 64),
            Err(SectionError::Content("starts of coarse sets"))
        );
    }
}
