//! What processors with AVX2 or AVX-512 do.

use std::arch::x86_64::*;

use super::{BinVotes, HEADINGS, HeadingLanes, IntervalRows, TABLE};
use crate::tables::look_up_avx2;

/// Two registers of 32 headings.
#[derive(Clone, Copy)]
pub(in crate::search) struct Avx2([__m256i; 2]);

/// Headings of a register.
const HALF: usize = HEADINGS / 2;

/// The votes in the bin of each interval that is nearest to the centre.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn look_up(votes: &BinVotes, first: &[u8; HALF], last: &[u8; HALF]) -> __m256i {
    // SAFETY: as the caller says, and arrays are as long as what is read of them.
    unsafe {
        let first = _mm256_loadu_si256(first.as_ptr().cast());
        let last = _mm256_loadu_si256(last.as_ptr().cast());
        let bin = _mm256_min_epu8(_mm256_set1_epi8(votes.centre.cast_signed()), last);
        let bin = _mm256_max_epu8(bin, first);
        let mut index = _mm256_subs_epu8(bin, _mm256_set1_epi8(votes.base.cast_signed()));
        // Only then is the last entry, which stands for those beyond, anything but 0.
        if usize::from(votes.used) == TABLE {
            index = _mm256_min_epu8(index, _mm256_set1_epi8(TABLE as i8 - 1));
        }
        look_up_avx2(&votes.table, votes.used.into(), index)
    }
}

#[inline(always)]
fn half_of(row: &[u8; HEADINGS], half: usize) -> &[u8; HALF] {
    &row.as_chunks().0[half]
}

#[expect(
    clippy::undocumented_unsafe_blocks,
    reason = "one argument holds for all: lanes of an instruction set are made only where the \
              processor has it, and arrays are as long as what is stored to them"
)]
impl HeadingLanes for Avx2 {
    /// For each register, of the first and of the second eight headings of each 16.
    type Sums = [[__m256i; 2]; 2];

    #[inline(always)]
    fn none() -> Self {
        unsafe { Avx2([_mm256_setzero_si256(); 2]) }
    }

    #[inline(always)]
    fn of_beam(votes: &BinVotes, rows: IntervalRows<'_>) -> Self {
        let [near_first, near_last, far_first, far_last] = rows;
        let mut most = Self::none();
        for (half, most) in most.0.iter_mut().enumerate() {
            unsafe {
                let near = look_up(votes, half_of(near_first, half), half_of(near_last, half));
                let far = look_up(votes, half_of(far_first, half), half_of(far_last, half));
                *most = _mm256_max_epu8(near, far);
            }
        }
        most
    }

    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for (sum, votes) in self.0.iter_mut().zip(other.0) {
            *sum = unsafe { _mm256_add_epi8(*sum, votes) };
        }
        self
    }

    #[inline(always)]
    fn present(self) -> u64 {
        let mut present = 0;
        for (half, votes) in self.0.into_iter().enumerate() {
            let absent =
                unsafe { _mm256_movemask_epi8(_mm256_cmpeq_epi8(votes, _mm256_setzero_si256())) };
            present |= u64::from(!absent.cast_unsigned()) << (HALF * half);
        }
        present
    }

    #[inline(always)]
    fn to_bytes(self) -> [u8; HEADINGS] {
        let mut bytes = [0; HEADINGS];
        for (votes, bytes) in self.0.into_iter().zip(bytes.chunks_exact_mut(HALF)) {
            unsafe { _mm256_storeu_si256(bytes.as_mut_ptr().cast(), votes) };
        }
        bytes
    }

    #[inline(always)]
    fn no_sums() -> Self::Sums {
        unsafe { [[_mm256_setzero_si256(); 2]; 2] }
    }

    #[inline(always)]
    fn add_to(self, mut sums: Self::Sums) -> Self::Sums {
        for (votes, [low, high]) in self.0.into_iter().zip(&mut sums) {
            unsafe {
                let zero = _mm256_setzero_si256();
                *low = _mm256_add_epi16(*low, _mm256_unpacklo_epi8(votes, zero));
                *high = _mm256_add_epi16(*high, _mm256_unpackhi_epi8(votes, zero));
            }
        }
        sums
    }

    #[inline(always)]
    fn at_least(sums: Self::Sums, least: u16) -> u64 {
        let mut reaching = 0;
        for (half, [low, high]) in sums.into_iter().enumerate() {
            unsafe {
                let (least, zero) = (
                    _mm256_set1_epi16(least.cast_signed()),
                    _mm256_setzero_si256(),
                );
                let low = _mm256_cmpeq_epi16(_mm256_subs_epu16(least, low), zero);
                let high = _mm256_cmpeq_epi16(_mm256_subs_epu16(least, high), zero);
                // Packing puts the headings back in order.
                let half_reaching = _mm256_movemask_epi8(_mm256_packs_epi16(low, high));
                reaching |= u64::from(half_reaching.cast_unsigned()) << (HALF * half);
            }
        }
        reaching
    }

    #[inline(always)]
    fn store(sums: Self::Sums, to: &mut [u16; HEADINGS]) {
        for ([low, high], to) in sums.into_iter().zip(to.chunks_exact_mut(HALF)) {
            unsafe {
                let to = to.as_mut_ptr();
                _mm256_storeu_si256(to.cast(), _mm256_permute2x128_si256::<0x20>(low, high));
                let rest = _mm256_permute2x128_si256::<0x31>(low, high);
                _mm256_storeu_si256(to.add(HALF / 2).cast(), rest);
            }
        }
    }
}

/// The votes in the bin of each interval that is nearest to the centre.
///
/// # Safety
/// The processor must have AVX-512 with VBMI.
#[inline(always)]
unsafe fn look_up_at_once(
    votes: &BinVotes,
    first: &[u8; HEADINGS],
    last: &[u8; HEADINGS],
) -> __m512i {
    // SAFETY: as the caller says, and arrays are as long as what is read of them.
    unsafe {
        let first = _mm512_loadu_si512(first.as_ptr().cast());
        let last = _mm512_loadu_si512(last.as_ptr().cast());
        let bin = _mm512_min_epu8(_mm512_set1_epi8(votes.centre.cast_signed()), last);
        let bin = _mm512_max_epu8(bin, first);
        let index = _mm512_subs_epu8(bin, _mm512_set1_epi8(votes.base.cast_signed()));
        let index = _mm512_min_epu8(index, _mm512_set1_epi8(TABLE as i8 - 1));
        _mm512_permutexvar_epi8(index, _mm512_loadu_si512(votes.table.as_ptr().cast()))
    }
}

/// A register of 64 headings.
#[derive(Clone, Copy)]
pub(in crate::search) struct Avx512(__m512i);

#[expect(
    clippy::undocumented_unsafe_blocks,
    reason = "one argument holds for all: lanes of an instruction set are made only where the \
              processor has it, and arrays are as long as what is read of them or stored to them"
)]
impl HeadingLanes for Avx512 {
    /// Of the first and of the second eight headings of each 16.
    type Sums = [__m512i; 2];

    #[inline(always)]
    fn none() -> Self {
        unsafe { Avx512(_mm512_setzero_si512()) }
    }

    #[inline(always)]
    fn of_beam(votes: &BinVotes, rows: IntervalRows<'_>) -> Self {
        unsafe {
            let [near_first, near_last, far_first, far_last] = rows;
            let near = look_up_at_once(votes, near_first, near_last);
            let far = look_up_at_once(votes, far_first, far_last);
            Avx512(_mm512_max_epu8(near, far))
        }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        unsafe { Avx512(_mm512_add_epi8(self.0, other.0)) }
    }

    #[inline(always)]
    fn present(self) -> u64 {
        unsafe { _mm512_test_epi8_mask(self.0, self.0) }
    }

    #[inline(always)]
    fn to_bytes(self) -> [u8; HEADINGS] {
        let mut bytes = [0; HEADINGS];
        unsafe { _mm512_storeu_si512(bytes.as_mut_ptr().cast(), self.0) };
        bytes
    }

    #[inline(always)]
    fn no_sums() -> Self::Sums {
        unsafe { [_mm512_setzero_si512(); 2] }
    }

    #[inline(always)]
    fn add_to(self, [low, high]: Self::Sums) -> Self::Sums {
        unsafe {
            let zero = _mm512_setzero_si512();
            [
                _mm512_add_epi16(low, _mm512_unpacklo_epi8(self.0, zero)),
                _mm512_add_epi16(high, _mm512_unpackhi_epi8(self.0, zero)),
            ]
        }
    }

    #[inline(always)]
    fn at_least([low, high]: Self::Sums, least: u16) -> u64 {
        unsafe {
            let least = _mm512_set1_epi16(least.cast_signed());
            let low = _mm512_movm_epi16(_mm512_cmpge_epu16_mask(low, least));
            let high = _mm512_movm_epi16(_mm512_cmpge_epu16_mask(high, least));
            // Packing puts the headings back in order.
            _mm512_movepi8_mask(_mm512_packs_epi16(low, high))
        }
    }

    #[inline(always)]
    fn store([low, high]: Self::Sums, to: &mut [u16; HEADINGS]) {
        let mut sums = [[0u16; HEADINGS / 2]; 2];
        unsafe {
            _mm512_storeu_si512(sums[0].as_mut_ptr().cast(), low);
            _mm512_storeu_si512(sums[1].as_mut_ptr().cast(), high);
        }
        for (i, to) in to.chunks_exact_mut(8).enumerate() {
            to.copy_from_slice(&sums[i % 2][i / 2 * 8..][..8]);
        }
    }
}
