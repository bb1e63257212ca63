//! Votes of the 16 cells of a small block.

use super::CELLS;
use crate::tables::VoteTable;

/// Votes of the cells of a block.
pub(crate) trait CellLanes: Copy {
    /// The token of the instruction set.
    type Set: Copy;

    fn load(set: Self::Set, votes: &[u16; CELLS]) -> Self;

    /// Adds the votes of a beam, given the ranges that the cells see along it. All but plain
    /// code need a short table.
    fn add(self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Self;

    fn votes(self) -> [u16; CELLS];

    /// Returns the most votes of the cells that have all ones in a mask.
    fn most(self, among: &[u16; CELLS]) -> u16;
}

/// The baseline CPU; on ARM, which always has NEON, short tables are looked
/// up by its instructions.
#[derive(Clone, Copy)]
pub(crate) struct Portable([u16; CELLS]);

impl Portable {
    /// Loads votes without a token, with any instruction set.
    #[inline(always)]
    pub(crate) fn new(votes: &[u16; CELLS]) -> Self {
        Portable(*votes)
    }
}

impl CellLanes for Portable {
    type Set = super::Portable;

    #[inline(always)]
    fn load(_: Self::Set, votes: &[u16; CELLS]) -> Self {
        Portable(*votes)
    }

    #[inline(always)]
    fn add(mut self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Self {
        #[cfg(target_arch = "aarch64")]
        if let Some(entries) = table.short() {
            neon::add((table, entries), ranges, &mut self.0);
            return self;
        }
        table.add(ranges, &mut self.0);
        self
    }

    #[inline(always)]
    fn votes(self) -> [u16; CELLS] {
        self.0
    }

    #[inline(always)]
    fn most(self, among: &[u16; CELLS]) -> u16 {
        let votes = self.0.iter().zip(among).map(|(votes, mask)| votes & mask);
        votes.fold(0, u16::max)
    }
}

#[cfg(target_arch = "aarch64")]
mod neon {
    use super::{CELLS, VoteTable};
    use crate::simd::table::look_up_neon;
    use crate::tables::TABLE;

    /// Adds the votes for ranges by a table and its entries.
    #[inline(always)]
    pub(super) fn add(
        (table, entries): (VoteTable<'_>, &[u8; TABLE]),
        ranges: &[u16; CELLS],
        votes: &mut [u16; CELLS],
    ) {
        let index = ranges.map(|range| range.abs_diff(table.centre).min(table.used) as u8);
        let found = look_up_neon(entries, table.used.into(), index);
        for (votes, found) in votes.iter_mut().zip(found) {
            *votes += u16::from(found);
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use bytemuck::must_cast;

    use super::{CELLS, CellLanes, VoteTable};
    use crate::simd::table::look_up_avx2;
    use crate::simd::{Avx2, avx2};

    /// Panic message: with AVX2, no long tables are looked up here.
    const SHORT: &str = "a table that is short";

    avx2! {
        /// Returns the greatest of the numbers that have all ones in a mask.
        fn most(_set: Avx2, numbers: __m256i, among: &[u16; CELLS]) -> u16 {
            let numbers = _mm256_and_si256(numbers, must_cast(*among));
            let (low, high) = (
                _mm256_castsi256_si128(numbers),
                _mm256_extracti128_si256::<1>(numbers),
            );
            // There is an instruction for the least of eight numbers.
            let inverted = _mm_xor_si128(_mm_max_epu16(low, high), _mm_set1_epi16(-1));
            !(_mm_cvtsi128_si32(_mm_minpos_epu16(inverted)) as u16)
        }
    }

    avx2! {
        /// Returns the places of ranges in a table.
        fn places(_set: Avx2, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> __m256i {
            let ranges = must_cast(*ranges);
            let centre = _mm256_set1_epi16(table.centre.cast_signed());
            let (beyond, before) = (
                _mm256_subs_epu16(ranges, centre),
                _mm256_subs_epu16(centre, ranges),
            );
            let last = _mm256_set1_epi16(table.used.cast_signed());
            _mm256_min_epu16(_mm256_or_si256(beyond, before), last)
        }
    }

    #[derive(Clone, Copy)]
    pub(crate) struct Avx2Cells(Avx2, __m256i);

    avx2! {
        impl CellLanes for Avx2Cells {
            type Set = Avx2;

            fn load(set: Avx2, votes: &[u16; CELLS]) -> Avx2Cells {
                Avx2Cells(set, must_cast(*votes))
            }

            fn add(self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Avx2Cells {
                let Avx2Cells(set, votes) = self;
                let entries = table.short().expect(SHORT);
                // The high byte of each number is beyond all entries.
                let high = _mm256_set1_epi16(0xff00_u16.cast_signed());
                let index = _mm256_or_si256(places(set, table, ranges), high);
                let [found] = look_up_avx2(set, entries, table.used.into(), [index]);
                Avx2Cells(set, _mm256_add_epi16(votes, found))
            }

            fn votes(self) -> [u16; CELLS] {
                must_cast(self.1)
            }

            fn most(self, among: &[u16; CELLS]) -> u16 {
                most(self.0, self.1, among)
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::Avx2Cells;
