//! Votes at 64 adjacent headings.

#[cfg(target_arch = "x86_64")]
mod x86;

use super::table::{LANES, Tables};
use crate::tables::TABLE;
#[cfg(target_arch = "x86_64")]
pub(crate) use x86::Avx2Headings;

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

/// A number of votes for each heading that fits a byte.
pub(crate) trait HeadingLanes: Copy {
    /// The token of the instruction set.
    type Set: Copy;
    fn none(set: Self::Set) -> Self;

    /// Returns the most votes that a beam has for a range of either interval.
    fn of_beam(set: Self::Set, votes: &BinVotes, rows: IntervalRows<'_>) -> Self;

    fn add(self, other: Self) -> Self;

    /// Returns a bit for each heading with any votes.
    fn present(self) -> u64;

    fn to_bytes(self) -> [u8; HEADINGS];
}

/// The baseline CPU; on ARM, which always has NEON, tables are looked up by
/// its instructions.
#[derive(Clone, Copy)]
pub(crate) struct Portable([u8; HEADINGS]);

impl HeadingLanes for Portable {
    type Set = super::Portable;

    #[inline(always)]
    fn none(_: Self::Set) -> Self {
        Portable([0; HEADINGS])
    }

    #[inline(always)]
    fn of_beam(_: Self::Set, votes: &BinVotes, rows: IntervalRows<'_>) -> Self {
        let [near_first, near_last, far_first, far_last] = rows;
        let near = look_up(votes, near_first, near_last);
        let far = look_up(votes, far_first, far_last);
        Portable(std::array::from_fn(|i| near[i].max(far[i])))
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Portable(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    #[inline(always)]
    fn present(self) -> u64 {
        let lanes = self.0.iter().enumerate();
        lanes.fold(0, |all, (i, &votes)| all | u64::from(votes > 0) << i)
    }

    #[inline(always)]
    fn to_bytes(self) -> [u8; HEADINGS] {
        self.0
    }
}

/// Looks up the votes in the bin of each interval that is nearest to the centre.
#[inline(always)]
fn look_up(votes: &BinVotes, first: &[u8; HEADINGS], last: &[u8; HEADINGS]) -> [u8; HEADINGS] {
    let index = std::array::from_fn(|i| {
        let bin = votes.centre.min(last[i]).max(first[i]);
        bin.saturating_sub(votes.base).min(TABLE as u8 - 1)
    });
    let halves: [[u8; LANES]; HEADINGS / LANES] = bytemuck::must_cast::<[u8; HEADINGS], _>(index);
    let [low, high] = halves;
    let look_up = |index| super::Portable.look_up(&votes.table, votes.used.into(), index);
    bytemuck::must_cast([look_up(low), look_up(high)])
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::simd::{Kernel, Set, Simd};

    /// Kernel that returns the votes of some beams in some rows, and bits for the headings with
    /// any.
    struct Counting<'a>(&'a [(BinVotes, [[u8; HEADINGS]; 4])]);

    impl Kernel for Counting<'_> {
        type Result = ([u8; HEADINGS], u64);

        #[inline(always)]
        fn run<S: Set>(self, set: S) -> Self::Result {
            let mut votes = S::Headings::none(set);
            for (beam, rows) in self.0 {
                votes = votes.add(S::Headings::of_beam(set, beam, rows.each_ref()));
            }
            (votes.to_bytes(), votes.present())
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
