//! Votes of the 16 cells of a small block, side by side in the registers of an
//! instruction set.

use crate::search::index::intervals::CELLS;
use crate::tables::VoteTable;

/// Votes of the cells of a block.
///
/// The methods must be inlined into functions that are compiled for the
/// instruction set, and be called only where the processor has it.
pub(in crate::search) trait CellLanes: Copy {
    fn load(votes: &[u16; CELLS]) -> Self;

    /// Adds those of a beam, given the ranges that the cells see along it. All but
    /// plain code needs a table that is short.
    fn add(self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Self;

    fn store(self, votes: &mut [u16; CELLS]);

    /// The most votes of those cells that have all ones in a mask.
    fn most(self, among: &[u16; CELLS]) -> u16;
}

/// What every processor has; on ARM, which always has NEON, short tables are looked
/// up by its instructions.
#[derive(Clone, Copy)]
pub(in crate::search) struct Portable([u16; CELLS]);

impl CellLanes for Portable {
    #[inline(always)]
    fn load(votes: &[u16; CELLS]) -> Self {
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
    fn store(self, votes: &mut [u16; CELLS]) {
        *votes = self.0;
    }

    #[inline(always)]
    fn most(self, among: &[u16; CELLS]) -> u16 {
        let votes = self.0.iter().zip(among).map(|(votes, mask)| votes & mask);
        votes.fold(0, u16::max)
    }
}

#[cfg(target_arch = "aarch64")]
mod neon {
    use std::arch::aarch64::*;

    use super::{CELLS, VoteTable};
    use crate::tables::{TABLE, look_up_neon};

    /// Adds the votes for ranges by a table and its entries.
    #[inline(always)]
    pub(in crate::search) fn add(
        (table, entries): (VoteTable<'_>, &[u8; TABLE]),
        ranges: &[u16; CELLS],
        votes: &mut [u16; CELLS],
    ) {
        // SAFETY: every ARM processor of 64 bits has NEON; arrays are as long as what is
        // read of them or stored to them.
        unsafe {
            let centre = vdupq_n_u16(table.centre);
            let low = vabdq_u16(vld1q_u16(ranges.as_ptr()), centre);
            let high = vabdq_u16(vld1q_u16(ranges.as_ptr().add(CELLS / 2)), centre);
            let last = vdupq_n_u16(table.used);
            let (low, high) = (vminq_u16(low, last), vminq_u16(high, last));
            let distance = vcombine_u8(vmovn_u16(low), vmovn_u16(high));
            let found = look_up_neon(entries, table.used.into(), distance);
            let (first, second) = votes.split_at_mut(CELLS / 2);
            for (to, found) in [(first, vget_low_u8(found)), (second, vget_high_u8(found))] {
                vst1q_u16(to.as_mut_ptr(), vaddw_u8(vld1q_u16(to.as_ptr()), found));
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::{CELLS, CellLanes, VoteTable};
    use crate::tables::look_up_avx2;

    /// Why tables are short: with these instruction sets no others are looked up here.
    const SHORT: &str = "a table that is short";

    #[derive(Clone, Copy)]
    pub(crate) struct Avx2(__m256i);

    #[derive(Clone, Copy)]
    pub(crate) struct Avx512(__m256i);

    /// Loads votes to a register.
    ///
    /// # Safety
    /// The processor must have AVX.
    #[inline(always)]
    unsafe fn load(numbers: &[u16; CELLS]) -> __m256i {
        // SAFETY: as the caller says, and the array is as long as a register.
        unsafe { _mm256_loadu_si256(numbers.as_ptr().cast()) }
    }

    /// The greatest of the numbers that have all ones in a mask.
    ///
    /// # Safety
    /// The processor must have AVX2.
    #[inline(always)]
    unsafe fn most(numbers: __m256i, among: &[u16; CELLS]) -> u16 {
        // SAFETY: as the caller says.
        unsafe {
            let numbers = _mm256_and_si256(numbers, load(among));
            let (low, high) = (
                _mm256_castsi256_si128(numbers),
                _mm256_extracti128_si256::<1>(numbers),
            );
            // There is an instruction for the least of eight numbers.
            let inverted = _mm_xor_si128(_mm_max_epu16(low, high), _mm_set1_epi16(-1));
            !(_mm_cvtsi128_si32(_mm_minpos_epu16(inverted)) as u16)
        }
    }

    /// Where a table has the votes for ranges.
    ///
    /// # Safety
    /// The processor must have AVX2.
    #[inline(always)]
    unsafe fn places(table: VoteTable<'_>, ranges: &[u16; CELLS]) -> __m256i {
        // SAFETY: as the caller says.
        unsafe {
            let ranges = load(ranges);
            let centre = _mm256_set1_epi16(table.centre.cast_signed());
            let (beyond, before) = (
                _mm256_subs_epu16(ranges, centre),
                _mm256_subs_epu16(centre, ranges),
            );
            let last = _mm256_set1_epi16(table.used.cast_signed());
            _mm256_min_epu16(_mm256_or_si256(beyond, before), last)
        }
    }

    #[expect(
        clippy::undocumented_unsafe_blocks,
        reason = "one argument holds for all: lanes of an instruction set are made only where the \
                  processor has it, and arrays are as long as what is read of them or stored to them"
    )]
    impl CellLanes for Avx2 {
        #[inline(always)]
        fn load(votes: &[u16; CELLS]) -> Self {
            unsafe { Avx2(load(votes)) }
        }

        #[inline(always)]
        fn add(self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Self {
            let entries = table.short().expect(SHORT);
            unsafe {
                // The high byte of each number lies beyond all entries.
                let high = _mm256_set1_epi16(0xff00_u16.cast_signed());
                let index = _mm256_or_si256(places(table, ranges), high);
                let found = look_up_avx2(entries, table.used.into(), index);
                Avx2(_mm256_add_epi16(self.0, found))
            }
        }

        #[inline(always)]
        fn store(self, votes: &mut [u16; CELLS]) {
            unsafe { _mm256_storeu_si256(votes.as_mut_ptr().cast(), self.0) };
        }

        #[inline(always)]
        fn most(self, among: &[u16; CELLS]) -> u16 {
            unsafe { most(self.0, among) }
        }
    }

    #[expect(
        clippy::undocumented_unsafe_blocks,
        reason = "one argument holds for all: lanes of an instruction set are made only where the \
                  processor has it, and arrays are as long as what is read of them or stored to them"
    )]
    impl CellLanes for Avx512 {
        #[inline(always)]
        fn load(votes: &[u16; CELLS]) -> Self {
            unsafe { Avx512(load(votes)) }
        }

        #[inline(always)]
        fn add(self, table: VoteTable<'_>, ranges: &[u16; CELLS]) -> Self {
            let entries = table.short().expect(SHORT);
            unsafe {
                let index = places(table, ranges);
                // The index is the low byte of a number; the high one looks up
                // entry 0, which the mask leaves out.
                let (index, entries) = (
                    _mm512_castsi256_si512(index),
                    _mm512_loadu_si512(entries.as_ptr().cast()),
                );
                let found = _mm512_maskz_permutexvar_epi8(0x5555_5555, index, entries);
                Avx512(_mm256_add_epi16(self.0, _mm512_castsi512_si256(found)))
            }
        }

        #[inline(always)]
        fn store(self, votes: &mut [u16; CELLS]) {
            unsafe { _mm256_storeu_si256(votes.as_mut_ptr().cast(), self.0) };
        }

        #[inline(always)]
        fn most(self, among: &[u16; CELLS]) -> u16 {
            unsafe { most(self.0, among) }
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub(in crate::search) use x86::{Avx2, Avx512};
