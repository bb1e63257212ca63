//! The tapers of a scan program as tables that can be looked up side by side.

use crate::directions::Directions;
use crate::program::ScanProgram;

/// A table's size is a multiple of this: what one instruction can look up.
pub(crate) const TABLE: usize = 64;

/// The same for processors that look up less.
pub(crate) const PIECE: usize = 16;

/// The tables of all beams, for each class of directions; made anew for each
/// program.
#[derive(Debug, Clone, Default)]
pub(crate) struct VoteTables {
    classes: usize,
    /// For beam `i` and class `c` at `i · classes + c`.
    entries: Vec<Entry>,
    votes: Vec<u8>,
    is_short: bool,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    centre: u16,
    start: u32,
    size: u32,
    used: u32,
}

/// Votes by distance from the reading. Its size is a multiple of [`TABLE`], and
/// its last entry is zero: farther distances look that up.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VoteTable<'a> {
    /// Steps to the reading.
    pub centre: u16,
    /// Votes at 0, 1, 2, … steps from there.
    pub votes: &'a [u8],
    /// From here on they are 0.
    pub used: usize,
}

impl VoteTables {
    pub(crate) fn make(&mut self, program: &ScanProgram, directions: &Directions) {
        let classes = directions.classes();
        self.classes = classes;
        self.entries.clear();
        self.votes.clear();
        self.is_short = true;
        for (beam, class) in (0..program.beams()).flat_map(|i| (0..classes).map(move |c| (i, c))) {
            let taper = program.taper(beam, class);
            let start = self.votes.len();
            let size = (taper.profile.len() + 1).next_multiple_of(TABLE);
            self.votes.extend_from_slice(taper.profile);
            self.votes.resize(start + size, 0);
            self.entries.push(Entry {
                centre: taper.centre,
                start: start as u32,
                size: size as u32,
                used: taper.profile.len() as u32,
            });
            self.is_short &= size == TABLE;
        }
    }

    /// The table of a beam for a class of directions.
    #[inline(always)]
    pub(crate) fn get(&self, beam: usize, class: usize) -> VoteTable<'_> {
        let Entry {
            centre,
            start,
            size,
            used,
        } = self.entries[beam * self.classes + class];
        VoteTable {
            centre,
            votes: &self.votes[start as usize..][..size as usize],
            used: used as usize,
        }
    }

    /// Whether all tables have [`TABLE`] entries.
    pub(crate) fn are_short(&self) -> bool {
        self.is_short
    }
}

impl VoteTable<'_> {
    /// Whether it has [`TABLE`] entries.
    #[cfg(target_arch = "aarch64")]
    #[inline(always)]
    pub(crate) fn is_short(&self) -> bool {
        self.votes.len() == TABLE
    }

    /// Adds the votes for poses from which the ray is so long, side by side.
    #[inline(always)]
    pub(crate) fn add(&self, ranges: &[u16], votes: &mut [u16]) {
        let last = self.votes.len() - 1;
        for (votes, &range) in votes.iter_mut().zip(ranges) {
            let distance = usize::from(range.abs_diff(self.centre)).min(last);
            *votes += u16::from(self.votes[distance]);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::program::NO_RANGE;
    use crate::testing::any_scan;

    proptest! {
        #[test]
        fn tables_give_the_votes_of_the_taper(
            scan in any_scan(), ranges in vec(prop_oneof![9 => 0u16..80, 1 => Just(NO_RANGE)], 0..150),
        ) {
            let space = crate::space::Space::new(16, 0.1, 40, 40).unwrap();
            let program = scan.program(&space);
            let mut tables = VoteTables::default();
            tables.make(&program, &space.directions);
            for (beam, class) in (0..program.beams()).flat_map(|i| (0..3).map(move |c| (i, c))) {
                let taper = program.taper(beam, class);
                let plain: Vec<u16> = ranges.iter().map(|&range| 1 + u16::from(taper.votes(range))).collect();
                let mut votes = vec![1; ranges.len()];
                tables.get(beam, class).add(&ranges, &mut votes);
                prop_assert_eq!(&votes, &plain);
            }
        }
    }
}
