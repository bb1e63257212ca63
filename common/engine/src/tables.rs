//! Tapers of a scan program as tables for lookups of several ranges at once.

use crate::directions::Directions;
use crate::program::ScanProgram;
use crate::simd::CELLS;
use crate::simd::table::{LANES, Tables};

/// Largest number of entries of a short table, which one instruction can look up.
pub(crate) const TABLE: usize = 64;

/// Tables of all beams for each class of directions, made for each program. They are contiguous,
/// because a search reads them again and again and they fill most of the inner caches.
#[derive(Debug, Clone, Default)]
pub(crate) struct VoteTables {
    classes: usize,
    /// Entry of beam `i` and class `c` at `i · classes + c`.
    entries: Vec<Entry>,
    votes: Vec<u8>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    start: u32,
    centre: u16,
    used: u16,
}

/// Votes by distance from the reading.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VoteTable<'a> {
    /// Number of steps to the reading.
    pub centre: u16,
    /// Number of entries with votes.
    pub used: u16,
    /// Votes at 0, 1, 2, … steps from there, and a 0 for larger distances. The bytes behind it
    /// belong to other tables; there are at least [`TABLE`] bytes.
    votes: &'a [u8],
}

impl VoteTables {
    pub(crate) fn make(&mut self, program: &ScanProgram, directions: &Directions) {
        let classes = directions.classes();
        self.classes = classes;
        self.entries.clear();
        self.votes.clear();
        for (beam, class) in (0..program.beams()).flat_map(|i| (0..classes).map(move |c| (i, c))) {
            let taper = program.taper(beam, class);
            self.entries.push(Entry {
                start: self.votes.len() as u32,
                centre: taper.centre,
                used: taper.profile.len() as u16,
            });
            self.votes.extend_from_slice(taper.profile);
            self.votes.push(0);
        }
        self.votes.resize(self.votes.len() + TABLE, 0);
    }

    /// Returns the table of a beam for a class of directions.
    #[inline(always)]
    pub(crate) fn get(&self, beam: usize, class: usize) -> VoteTable<'_> {
        let Entry {
            start,
            centre,
            used,
        } = self.entries[beam * self.classes + class];
        VoteTable {
            centre,
            used,
            votes: &self.votes[start as usize..],
        }
    }
}

impl<'a> VoteTable<'a> {
    /// Returns the entries, including the last one at [`VoteTable::used`], if there are at most
    /// [`TABLE`].
    #[inline(always)]
    fn short(self) -> Option<&'a [u8; TABLE]> {
        let is_short = usize::from(self.used) < TABLE;
        self.votes.first_chunk().filter(|_| is_short)
    }

    /// True if any number of steps in this range, end excluded, may have votes.
    #[inline(always)]
    pub(crate) fn has_votes_in(&self, (first, end): (u16, u16)) -> bool {
        let (centre, used) = (usize::from(self.centre), usize::from(self.used));
        usize::from(first) < centre + used && centre + 1 < usize::from(end) + used
    }

    /// Adds the votes for poses whose rays have these lengths.
    #[inline(always)]
    pub(crate) fn add<T: Tables>(self, set: T, ranges: &[u16; CELLS], votes: &mut [u16; CELLS]) {
        let Some(entries) = self.short() else {
            for (votes, &range) in votes.iter_mut().zip(ranges) {
                let distance = range.abs_diff(self.centre).min(self.used);
                *votes += u16::from(self.votes[usize::from(distance)]);
            }
            return;
        };
        let mut index = [0; LANES];
        for (index, range) in index.iter_mut().zip(ranges) {
            *index = range.abs_diff(self.centre).min(self.used) as u8;
        }
        let found = set.look_up(entries, self.used.into(), index);
        for (votes, found) in votes.iter_mut().zip(found) {
            *votes += u16::from(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::program::NO_RANGE;
    use crate::simd::{Kernel, Set, Simd};
    use crate::testing::any_scan;

    /// Kernel that adds the votes of a beam.
    struct Adding<'a>(VoteTable<'a>, &'a [u16; CELLS], [u16; CELLS]);

    impl Kernel for Adding<'_> {
        type Result = [u16; CELLS];

        #[inline(always)]
        fn run<S: Set>(self, set: S) -> Self::Result {
            let Adding(table, ranges, mut votes) = self;
            table.add(set, ranges, &mut votes);
            votes
        }
    }

    proptest! {
        #[test]
        fn tables_give_the_votes_of_the_taper(
            scan in prop_oneof![any_scan(), any_scan().prop_map(|scan| scan.stretched(18.0))],
            ranges in vec(prop_oneof![9 => 0u16..80, 1 => Just(NO_RANGE)], CELLS),
        ) {
            let space = crate::space::Space::new(16, 0.1, 40, 40).unwrap();
            let program = scan.program(&space);
            let mut tables = VoteTables::default();
            tables.make(&program, &space.directions);
            let ranges: [u16; CELLS] = ranges.try_into().unwrap();
            for (beam, class) in (0..program.beams()).flat_map(|i| (0..3).map(move |c| (i, c))) {
                let taper = program.taper(beam, class);
                let plain = ranges.map(|range| 1 + u16::from(taper.votes(range)));
                for set in InstructionSet::available() {
                    let adding = Adding(tables.get(beam, class), &ranges, [1; CELLS]);
                    prop_assert_eq!(Simd::new(set).run(adding), plain, "{}", set);
                }
            }
        }
    }
}
