//! Bytes looked up in short tables.

use super::Portable;
pub(crate) use crate::tables::TABLE;

/// Number of bytes that are looked up together.
pub(crate) const LANES: usize = 32;

/// Look-ups of an instruction set.
pub(crate) trait Tables: Copy {
    /// Looks numbers up in a table of which `used` entries are not 0; numbers beyond those
    /// give 0.
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES];

    /// Returns a bit for each number that is not 0.
    fn present(self, numbers: [u8; LANES]) -> u32;
}

impl Tables for Portable {
    #[cfg(not(target_arch = "aarch64"))]
    #[inline(always)]
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
        let mut found = [0; LANES];
        for (found, index) in found.iter_mut().zip(index) {
            *found = if usize::from(index) < used {
                table[usize::from(index) % TABLE]
            } else {
                0
            };
        }
        found
    }

    #[cfg(target_arch = "aarch64")]
    #[inline(always)]
    fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
        let halves: [[u8; PIECE]; LANES / PIECE] = bytemuck::must_cast(index);
        bytemuck::must_cast(halves.map(|half| look_up_neon(table, used, half)))
    }

    #[inline(always)]
    fn present(self, numbers: [u8; LANES]) -> u32 {
        let numbers = numbers.iter().enumerate();
        numbers.fold(0, |bits, (i, &number)| bits | u32::from(number > 0) << i)
    }
}

/// Looks 16 numbers up in a table of which `used` entries are not 0; numbers beyond those
/// give 0. Every ARM processor of 64 bits has NEON.
#[cfg(target_arch = "aarch64")]
#[inline(always)]
pub(super) fn look_up_neon(table: &[u8; TABLE], used: usize, index: [u8; PIECE]) -> [u8; PIECE] {
    use std::arch::aarch64::*;

    use bytemuck::must_cast;

    let index: uint8x16_t = must_cast(index);
    let pieces: [uint8x16_t; 4] = must_cast(*table);
    must_cast(if used <= PIECE {
        // SAFETY: every processor of this architecture has NEON.
        unsafe { vqtbl1q_u8(pieces[0], index) }
    } else {
        let [first, second, third, fourth] = pieces;
        // SAFETY: every processor of this architecture has NEON.
        unsafe { vqtbl4q_u8(uint8x16x4_t(first, second, third, fourth), index) }
    })
}

/// Number of entries that an instruction of AVX2 and NEON looks up.
const PIECE: usize = 16;

/// Added to an index with AVX2, it sets the highest bit unless the index is below 16:
/// then nothing is looked up.
#[cfg(target_arch = "x86_64")]
pub(super) const BEYOND: i8 = (0x80 - PIECE) as i8;

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use bytemuck::{must_cast, must_cast_ref};

    use super::{BEYOND, LANES, PIECE, TABLE, Tables};
    use crate::simd::{Avx2, avx2};

    avx2! {
        /// Looks 32 numbers up in piece `number` of a table, and adds the results to `found`.
        fn look_up_piece(
            _set: Avx2,
            piece: &[u8; PIECE],
            number: usize,
            index: __m256i,
            found: __m256i,
        ) -> __m256i {
            // Numbers that go below 0 are beyond 16, too.
            let index = _mm256_sub_epi8(index, _mm256_set1_epi8((PIECE * number) as i8));
            let index = _mm256_adds_epu8(index, _mm256_set1_epi8(BEYOND));
            let piece = _mm256_broadcastsi128_si256(must_cast(*piece));
            _mm256_or_si256(found, _mm256_shuffle_epi8(piece, index))
        }
    }

    avx2! {
        fn present(_set: Avx2, numbers: __m256i) -> u32 {
            let absent = _mm256_cmpeq_epi8(numbers, _mm256_setzero_si256());
            !_mm256_movemask_epi8(absent).cast_unsigned()
        }
    }

    impl Tables for Avx2 {
        #[inline(always)]
        fn look_up(self, table: &[u8; TABLE], used: usize, index: [u8; LANES]) -> [u8; LANES] {
            let index = must_cast(index);
            let [first, others @ ..]: &[[u8; PIECE]; TABLE / PIECE] = must_cast_ref(table);
            let mut found = look_up_piece(self, first, 0, index, must_cast([0u8; LANES]));
            for (piece, number) in others.iter().zip(1..used.div_ceil(PIECE)) {
                found = look_up_piece(self, piece, number, index, found);
            }
            must_cast(found)
        }

        #[inline(always)]
        fn present(self, numbers: [u8; LANES]) -> u32 {
            present(self, must_cast(numbers))
        }
    }
}
