//! Vectors of 16-bit numbers, as wide as each instruction set has them.

use super::Portable;

/// Operations on vectors; numbers are unsigned unless said otherwise.
pub(crate) trait Numbers: Copy {
    type Vector: Copy;

    /// Numbers in a vector.
    const COUNT: usize;

    fn splat(self, value: u16) -> Self::Vector;

    /// Loads the first [`Numbers::COUNT`] numbers.
    fn load(self, from: &[u16]) -> Self::Vector;

    /// Stores to the first [`Numbers::COUNT`] numbers.
    fn store(self, vector: Self::Vector, to: &mut [u16]);

    /// Stores to the first [`Numbers::COUNT`] bytes; the numbers are at most 255.
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]);

    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn add_saturating(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub_saturating(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn and(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn or(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn min(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn max(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// Returns the greater numbers, compared as signed ones.
    fn max_signed(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `a · b >> 16`.
    fn mul_high(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `(a + b + 1) >> 1`.
    fn average(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// `a << 4`.
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector;

    /// Returns a bit for each number of `a` that is at least the one of `b`.
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64;

    /// Returns a bit for each lane in which `byte` is at most `reaches` after `behind`, in any
    /// row. Bytes wrap from 255 to 0.
    fn any_within(self, byte: u8, behind: &MarkedRows, reaches: &MarkedRows) -> u64;
}

/// Number of bytes that are marked at a time.
pub(crate) const MARKED: usize = 64;

/// Rows of bytes that are marked: of the near and the far interval of four blocks.
pub(crate) type MarkedRows = [[u8; MARKED]; 8];

/// Numbers of a vector of plain code.
const PORTABLE: usize = 8;

/// Operations lane by lane.
macro_rules! by_lane {
    ($($operation:ident($a:ident, $b:ident) $value:expr;)*) => {
        $(
            #[inline(always)]
            fn $operation(self, a: Self::Vector, b: Self::Vector) -> Self::Vector {
                std::array::from_fn(|i| {
                    let ($a, $b) = (a[i], b[i]);
                    $value
                })
            }
        )*
    };
}

impl Numbers for Portable {
    type Vector = [u16; PORTABLE];

    const COUNT: usize = PORTABLE;

    #[inline(always)]
    fn splat(self, value: u16) -> Self::Vector {
        [value; PORTABLE]
    }

    #[inline(always)]
    fn load(self, from: &[u16]) -> Self::Vector {
        let from = &from[..PORTABLE];
        std::array::from_fn(|i| from[i])
    }

    #[inline(always)]
    fn store(self, vector: Self::Vector, to: &mut [u16]) {
        to[..PORTABLE].copy_from_slice(&vector);
    }

    #[inline(always)]
    fn store_bytes(self, vector: Self::Vector, to: &mut [u8]) {
        to[..PORTABLE].copy_from_slice(&vector.map(|number| number as u8));
    }

    #[inline(always)]
    fn shift_nibble(self, a: Self::Vector) -> Self::Vector {
        a.map(|number| number << 4)
    }

    #[inline(always)]
    fn at_least(self, a: Self::Vector, b: Self::Vector) -> u64 {
        let pairs = a.iter().zip(&b).enumerate();
        pairs.fold(0, |bits, (i, (a, b))| bits | u64::from(a >= b) << i)
    }

    #[inline(always)]
    fn any_within(self, byte: u8, behind: &MarkedRows, reaches: &MarkedRows) -> u64 {
        // Distance of the byte beyond the nearest reach.
        let mut off = [u8::MAX; MARKED];
        for (behind, reaches) in behind.iter().zip(reaches) {
            for ((off, first), &reach) in off.iter_mut().zip(behind).zip(reaches) {
                *off = (*off).min(byte.wrapping_sub(*first).saturating_sub(reach));
            }
        }
        let mut bits = 0;
        for (i, off) in off.as_chunks::<8>().0.iter().enumerate() {
            let inside = u64::from_le_bytes(off.map(|off| u8::from(off == 0)));
            // Carries byte `j` to bit `56 + j`.
            bits |= inside.wrapping_mul(0x0102_0408_1020_4080) >> 56 << (8 * i);
        }
        bits
    }

    by_lane! {
        add(a, b) a.wrapping_add(b);
        add_saturating(a, b) a.saturating_add(b);
        sub(a, b) a.wrapping_sub(b);
        sub_saturating(a, b) a.saturating_sub(b);
        and(a, b) a & b;
        or(a, b) a | b;
        min(a, b) a.min(b);
        max(a, b) a.max(b);
        max_signed(a, b) a.cast_signed().max(b.cast_signed()).cast_unsigned();
        mul_high(a, b) ((u32::from(a) * u32::from(b)) >> 16) as u16;
        average(a, b) ((u32::from(a) + u32::from(b) + 1) >> 1) as u16;
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use bytemuck::must_cast;

    use super::{MarkedRows, Numbers};
    use crate::simd::{Avx2, avx2};

    const ENOUGH: &str = "as many numbers as a vector has";

    avx2! {
        impl Numbers for Avx2 {
            type Vector = __m256i;
            const COUNT: usize = 16;

            fn splat(self, value: u16) -> __m256i {
                _mm256_set1_epi16(value.cast_signed())
            }

            fn load(self, from: &[u16]) -> __m256i {
                must_cast(*from.first_chunk::<16>().expect(ENOUGH))
            }

            fn store(self, vector: __m256i, to: &mut [u16]) {
                *to.first_chunk_mut::<16>().expect(ENOUGH) = must_cast(vector);
            }

            fn store_bytes(self, vector: __m256i, to: &mut [u8]) {
                // Packing joins the halves of each half; the first and third hold numbers.
                let packed = _mm256_packus_epi16(vector, vector);
                let bytes = _mm256_castsi256_si128(_mm256_permute4x64_epi64::<0b1000>(packed));
                *to.first_chunk_mut::<16>().expect(ENOUGH) = must_cast(bytes);
            }

            fn add(self, a: __m256i, b: __m256i) -> __m256i { _mm256_add_epi16(a, b) }
            fn add_saturating(self, a: __m256i, b: __m256i) -> __m256i { _mm256_adds_epu16(a, b) }
            fn sub(self, a: __m256i, b: __m256i) -> __m256i { _mm256_sub_epi16(a, b) }
            fn sub_saturating(self, a: __m256i, b: __m256i) -> __m256i { _mm256_subs_epu16(a, b) }
            fn and(self, a: __m256i, b: __m256i) -> __m256i { _mm256_and_si256(a, b) }
            fn or(self, a: __m256i, b: __m256i) -> __m256i { _mm256_or_si256(a, b) }
            fn min(self, a: __m256i, b: __m256i) -> __m256i { _mm256_min_epu16(a, b) }
            fn max(self, a: __m256i, b: __m256i) -> __m256i { _mm256_max_epu16(a, b) }
            fn max_signed(self, a: __m256i, b: __m256i) -> __m256i { _mm256_max_epi16(a, b) }
            fn mul_high(self, a: __m256i, b: __m256i) -> __m256i { _mm256_mulhi_epu16(a, b) }
            fn average(self, a: __m256i, b: __m256i) -> __m256i { _mm256_avg_epu16(a, b) }
            fn shift_nibble(self, a: __m256i) -> __m256i { _mm256_slli_epi16::<4>(a) }

            fn at_least(self, a: __m256i, b: __m256i) -> u64 {
                let is = _mm256_cmpeq_epi16(_mm256_max_epu16(a, b), a);
                // Packing joins the halves of each half; the first and third hold bytes.
                let bytes = _mm256_packs_epi16(is, is);
                let bytes = _mm256_castsi256_si128(_mm256_permute4x64_epi64::<0b1000>(bytes));
                u64::from(_mm_movemask_epi8(bytes).cast_unsigned())
            }

            fn any_within(self, byte: u8, behind: &MarkedRows, reaches: &MarkedRows) -> u64 {
                let byte = _mm256_set1_epi8(byte.cast_signed());
                let mut off = [_mm256_set1_epi8(-1); 2];
                for (behind, reaches) in behind.iter().zip(reaches) {
                    let behind: [__m256i; 2] = must_cast(*behind);
                    let reaches: [__m256i; 2] = must_cast(*reaches);
                    for half in 0..2 {
                        let beyond = _mm256_sub_epi8(byte, behind[half]);
                        let beyond = _mm256_subs_epu8(beyond, reaches[half]);
                        off[half] = _mm256_min_epu8(off[half], beyond);
                    }
                }
                let mut bits = 0;
                for (half, off) in off.into_iter().enumerate() {
                    let inside = _mm256_cmpeq_epi8(off, _mm256_setzero_si256());
                    let inside = _mm256_movemask_epi8(inside).cast_unsigned();
                    bits |= u64::from(inside) << (32 * half);
                }
                bits
            }
        }
    }
}
