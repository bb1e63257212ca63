//! Ends of eight adjacent rays.

use super::{CELLS, SIDE};
use crate::program::NO_RANGE;

/// Number of rows of a word, and of adjacent rays in each.
pub(crate) const ROWS: i64 = 8;

/// Largest number of rays in a bundle.
pub(crate) const RAYS: usize = ROWS as usize;

/// Ends of adjacent rays.
pub(crate) trait RayLanes: Sized {
    /// The token of the instruction set.
    type Set: Copy;

    /// Returns lanes in which no ray has ended.
    fn none(set: Self::Set) -> Self;

    /// Returns eight bits of each of eight rows, a byte for each row.
    fn word(set: Self::Set, rows: &BitRows<'_>) -> u64;

    /// Notes the rays that end at one of eight positions, unless they ended before. Bit `i` of
    /// byte `j` of the word is set if ray `i` ends at `position + j`. Also returns a bit for
    /// each ray that ends in the word.
    fn note(self, word: u64, position: i64) -> (Self, u8);

    /// Returns the position at which each ray ends first, or [`NO_RANGE`].
    fn hits(self) -> [u16; RAYS];

    /// Returns the ranges of the cells of a block, given the ray of each column's first cell.
    fn ranges(
        set: Self::Set,
        hits: &[u16; RAYS],
        first: &[u16; SIDE],
        across: &Across,
    ) -> [u16; CELLS];
}

/// Order in which rays cross the cells of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Across {
    /// Number of columns that a ray has met before the cell.
    pub column: [u16; CELLS],
    /// Place of the cell in its column.
    pub minor: [u16; CELLS],
}

impl Across {
    /// Orders for rays along y and along x, each forward and backward.
    pub(crate) const ALL: [[Across; 2]; 2] = [
        [Across::new(false, false), Across::new(false, true)],
        [Across::new(true, false), Across::new(true, true)],
    ];

    const fn new(x_major: bool, backward: bool) -> Self {
        let (mut column, mut minor) = ([0; CELLS], [0; CELLS]);
        let mut cell = 0;
        while cell < CELLS {
            let (x, y) = ((cell % SIDE) as u16, (cell / SIDE) as u16);
            let (major, along) = if x_major { (x, y) } else { (y, x) };
            column[cell] = if backward {
                SIDE as u16 - 1 - major
            } else {
                major
            };
            minor[cell] = along;
            cell += 1;
        }
        Across { column, minor }
    }
}

/// Rows of bits on a slope.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BitRows<'a> {
    pub rows: &'a [u32; RAYS],
    /// First bit of the first row that is read, times 2³², and the increase for each further
    /// row. Eight bits are read in each row.
    pub bit: i64,
    pub slope: i64,
}

/// The baseline CPU.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Portable([u16; RAYS]);

impl RayLanes for Portable {
    type Set = super::Portable;

    #[inline(always)]
    fn none(_: Self::Set) -> Self {
        Portable([NO_RANGE; RAYS])
    }

    #[inline(always)]
    fn word(_: Self::Set, rows: &BitRows<'_>) -> u64 {
        let bytes = std::array::from_fn(|row| {
            let bit = (rows.bit + row as i64 * rows.slope) >> 32;
            (rows.rows[row] >> (bit & 31)) as u8
        });
        u64::from_le_bytes(bytes)
    }

    #[inline(always)]
    fn note(mut self, word: u64, position: i64) -> (Self, u8) {
        /// The bits of the first ray.
        const FIRST: u64 = 0x0101_0101_0101_0101;
        for (i, hit) in self.0.iter_mut().enumerate() {
            let ends = (word >> i) & FIRST;
            let at = position + i64::from(ends.trailing_zeros() / 8);
            let at = if ends == 0 { NO_RANGE } else { at as u16 };
            *hit = at.min(*hit);
        }
        let folded = word | word >> 32;
        let folded = folded | folded >> 16;
        (self, (folded | folded >> 8) as u8)
    }

    #[inline(always)]
    fn hits(self) -> [u16; RAYS] {
        self.0
    }

    #[inline(always)]
    fn ranges(
        _: Self::Set,
        hits: &[u16; RAYS],
        first: &[u16; SIDE],
        across: &Across,
    ) -> [u16; CELLS] {
        std::array::from_fn(|i| {
            let column = across.column[i];
            let hit = hits[usize::from(first[usize::from(column)] + across.minor[i])];
            if hit == NO_RANGE { hit } else { hit - column }
        })
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use bytemuck::must_cast;

    use super::{Across, BitRows, CELLS, NO_RANGE, Portable, RAYS, RayLanes, SIDE};
    use crate::simd::{self, Avx2, avx2};

    /// One ray in each lane of 64 bits, in two registers.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx2Rays([__m256i; 2]);

    avx2! {
        /// Returns those of eight numbers, which are stored twice, at places below eight.
        fn number_at(_set: Avx2, numbers: __m256i, places: __m256i) -> __m256i {
            let bytes = _mm256_mullo_epi16(places, _mm256_set1_epi16(0x0202));
            let bytes = _mm256_add_epi16(bytes, _mm256_set1_epi16(0x0100));
            _mm256_shuffle_epi8(numbers, bytes)
        }
    }

    avx2! {
        impl RayLanes for Avx2Rays {
            type Set = Avx2;

            fn none(_set: Avx2) -> Avx2Rays {
                Avx2Rays([_mm256_set1_epi64x(i64::from(NO_RANGE)); 2])
            }

            fn word(_set: Avx2, rows: &BitRows<'_>) -> u64 {
                Portable::word(simd::Portable, rows)
            }

            fn note(self, word: u64, position: i64) -> (Avx2Rays, u8) {
                let (mut hits, mut ended) = (self.0, 0);
                for (half, hits) in hits.iter_mut().enumerate() {
                    let ray = 4 * half as i64;
                    let zero = _mm256_setzero_si256();
                    let rays = _mm256_set_epi64x(ray + 3, ray + 2, ray + 1, ray);
                    let word = _mm256_set1_epi64x(word.cast_signed());
                    let first = _mm256_set1_epi64x(0x0101_0101_0101_0101);
                    let ends = _mm256_and_si256(_mm256_srlv_epi64(word, rays), first);
                    // There are as many bytes below the lowest bit as positions before it.
                    let below = _mm256_add_epi64(ends, _mm256_set1_epi64x(-1));
                    let below = _mm256_and_si256(_mm256_andnot_si256(ends, below), first);
                    let row = _mm256_sad_epu8(below, zero);
                    let at = _mm256_add_epi64(_mm256_set1_epi64x(position), row);
                    let goes_on = _mm256_cmpeq_epi64(ends, zero);
                    // Numbers fit the low half of a lane.
                    let at = _mm256_or_si256(at, goes_on);
                    *hits = _mm256_min_epu32(*hits, at);
                    let on = _mm256_movemask_pd(_mm256_castsi256_pd(goes_on));
                    ended |= (!on & 0b1111) << ray;
                }
                (Avx2Rays(hits), ended as u8)
            }

            fn hits(self) -> [u16; RAYS] {
                let packed = _mm256_packus_epi32(self.0[0], self.0[1]);
                let packed = _mm256_packus_epi32(packed, packed);
                let (low, high) = (
                    _mm256_castsi256_si128(packed),
                    _mm256_extracti128_si256::<1>(packed),
                );
                must_cast(_mm_unpacklo_epi32(low, high))
            }

            fn ranges(
                set: Avx2,
                hits: &[u16; RAYS],
                first: &[u16; SIDE],
                across: &Across,
            ) -> [u16; CELLS] {
                let (column, minor) = (must_cast(across.column), must_cast(across.minor));
                let hits = _mm256_broadcastsi128_si256(must_cast(*hits));
                let first = _mm256_set1_epi64x(must_cast(*first));
                let ray = _mm256_add_epi16(number_at(set, first, column), minor);
                let hit = number_at(set, hits, ray);
                let no_range = _mm256_cmpeq_epi16(hit, _mm256_set1_epi16(NO_RANGE as i16));
                must_cast(_mm256_sub_epi16(hit, _mm256_andnot_si256(no_range, column)))
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::Avx2Rays;
