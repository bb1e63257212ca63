//! Tapers of a scan program as tables for lookups of several ranges at once.

use crate::simd::{CELLS, LANES, Set, TABLE};

/// Votes by distance from the reading.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VoteTable<'a> {
    /// Number of steps to the reading.
    pub centre: u16,
    /// Number of entries with votes.
    pub used: u16,
    /// Votes at 0, 1, 2, … steps from there, and a 0 for larger distances. The bytes behind it
    /// belong to other tables; there are at least [`TABLE`] bytes.
    pub votes: &'a [u8],
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
    pub(crate) fn add<S: Set>(self, set: S, ranges: &[u16; CELLS], votes: &mut [u16; CELLS]) {
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
