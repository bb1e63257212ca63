//! Votes at 64 adjacent headings.

use super::{LANES, Set, TABLE};

/// Number of headings that are bounded at a time.
pub(crate) const HEADINGS: usize = 64;

/// First and last bins of two intervals, in the directions of a beam at [`HEADINGS`].
pub(crate) type IntervalRows<'a> = [&'a [u8; HEADINGS]; 4];

/// Most votes of a beam for a range in each bin; they never rise away from the centre.
#[derive(Debug, Clone)]
#[repr(C)]
pub(crate) struct BinVotes {
    /// Votes in bins `base`, `base + 1`, …; the first and the last stand for all bins beyond.
    pub table: [u8; TABLE],
    /// Number of entries after which all are 0.
    pub used: u8,
    /// Bin with the most votes.
    pub centre: u8,
    pub base: u8,
}

impl BinVotes {
    /// Adds the most votes of the beam for a range of either interval to those at each heading.
    #[inline(always)]
    pub(crate) fn add<S: Set>(
        &self,
        set: S,
        rows: IntervalRows<'_>,
        votes: &mut [u8; HEADINGS],
    ) -> [u8; HEADINGS] {
        let [near_first, near_last, far_first, far_last] = rows;
        let near = look_up(set, self, near_first, near_last);
        let far = look_up(set, self, far_first, far_last);
        let mut found = near;
        for i in 0..HEADINGS {
            found[i] = near[i].max(far[i]);
            votes[i] += found[i];
        }
        found
    }
}

/// Returns a bit for each heading with any votes.
#[inline(always)]
pub(crate) fn present<S: Set>(set: S, votes: [u8; HEADINGS]) -> u64 {
    let [low, high]: [[u8; LANES]; HEADINGS / LANES] = bytemuck::must_cast(votes);
    u64::from(set.present(low)) | u64::from(set.present(high)) << LANES
}

/// Looks up the votes in the bin of each interval that is nearest to the centre.
#[inline(always)]
fn look_up<S: Set>(
    set: S,
    votes: &BinVotes,
    first: &[u8; HEADINGS],
    last: &[u8; HEADINGS],
) -> [u8; HEADINGS] {
    let mut index = [0; HEADINGS];
    for i in 0..HEADINGS {
        let bin = votes.centre.min(last[i]).max(first[i]);
        index[i] = bin.saturating_sub(votes.base);
    }
    // Otherwise the last entry, which stands for all bins beyond, is 0.
    if usize::from(votes.used) == TABLE {
        index = index.map(|index| index.min(TABLE as u8 - 1));
    }
    let [low, high]: [[u8; LANES]; HEADINGS / LANES] = bytemuck::must_cast(index);
    let look_up = |index| set.look_up(&votes.table, votes.used.into(), index);
    bytemuck::must_cast([look_up(low), look_up(high)])
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::simd::{Kernel, Simd};

    /// Kernel that returns the votes of some beams in some rows, and bits for the headings with
    /// any.
    struct Counting<'a>(&'a [(BinVotes, [[u8; HEADINGS]; 4])]);

    impl Kernel for Counting<'_> {
        type Result = ([u8; HEADINGS], u64);

        #[inline(always)]
        fn run<S: Set>(self, set: S) -> Self::Result {
            let mut votes = [0; HEADINGS];
            for (beam, rows) in self.0 {
                beam.add(set, rows.each_ref(), &mut votes);
            }
            (votes, present(set, votes))
        }
    }

    fn any_row() -> impl Strategy<Value = [u8; HEADINGS]> {
        vec(any::<u8>(), HEADINGS).prop_map(|row| row.try_into().expect("as long"))
    }

    prop_compose! {
        fn any_votes()(
            votes in prop_oneof![vec(0u8..=15, 0..=16), vec(0u8..=15, 0..=TABLE)],
            centre: u8, base: u8,
        ) -> BinVotes {
            let mut table = [0; TABLE];
            table[..votes.len()].copy_from_slice(&votes);
            BinVotes { table, used: votes.len() as u8, centre, base }
        }
    }

    proptest! {
        #[test]
        fn votes_are_those_of_the_tables_on_every_instruction_set(
            beams in vec((any_votes(), [any_row(), any_row(), any_row(), any_row()]), 0..16),
        ) {
            let mut bytes = [0; HEADINGS];
            for (beam, [near_first, near_last, far_first, far_last]) in &beams {
                for (lane, votes) in bytes.iter_mut().enumerate() {
                    let in_bin = |first: u8, last: u8| {
                        let bin = beam.centre.min(last).max(first);
                        beam.table[usize::from(bin.saturating_sub(beam.base)).min(TABLE - 1)]
                    };
                    *votes += in_bin(near_first[lane], near_last[lane])
                        .max(in_bin(far_first[lane], far_last[lane]));
                }
            }
            let present = bytes.iter().enumerate();
            let present = present.fold(0, |all, (lane, &votes)| all | u64::from(votes > 0) << lane);
            for set in InstructionSet::available() {
                let found = Simd::new(set).run(Counting(&beams));
                prop_assert_eq!(found, (bytes, present), "{}", set);
            }
        }
    }
}
