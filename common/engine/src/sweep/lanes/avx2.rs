//! 32 bytes with AVX2: a look-up takes one instruction for 16 entries, and as
//! tapers are symmetric, 16 entries hold the distances on both sides.

use std::arch::x86_64::*;

use super::{Lanes, Lookup};
use crate::program::Taper;
use crate::tables::BEYOND;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2(__m256i);

/// All ones in a cell's byte.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    open: __m256i,
    occupied: __m256i,
}

/// What is left is never above 15.
const SHORT: u8 = 0;
/// Votes end before 15 are left.
const CLAMPED: u8 = 1;
/// By the distance from the reading, in parts of 16.
const BY_DISTANCE: u8 = 2;

impl Lanes for Avx2 {
    const WIDTH: usize = 32;
    type Pair = (__m256i, __m256i);
    type Cells = Cells;

    #[inline(always)]
    unsafe fn zero() -> Self {
        unsafe { Avx2(_mm256_setzero_si256()) }
    }

    #[inline(always)]
    unsafe fn splat(bytes: u32) -> Self {
        unsafe { Avx2(_mm256_set1_epi32(bytes as i32)) }
    }

    #[inline(always)]
    unsafe fn load(from: *const u8) -> Self {
        unsafe { Avx2(_mm256_loadu_si256(from.cast())) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut u8) {
        unsafe { _mm256_storeu_si256(to.cast(), self.0) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe { Avx2(_mm256_add_epi8(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn widen<const ADD: bool>(self, to: *mut u16) {
        unsafe {
            let halves = [
                _mm256_castsi256_si128(self.0),
                _mm256_extracti128_si256::<1>(self.0),
            ];
            for (i, half) in halves.into_iter().enumerate() {
                let to = to.add(16 * i);
                let mut numbers = _mm256_cvtepu8_epi16(half);
                if ADD {
                    numbers = _mm256_add_epi16(numbers, _mm256_loadu_si256(to.cast()));
                }
                _mm256_storeu_si256(to.cast(), numbers);
            }
        }
    }

    #[inline(always)]
    unsafe fn cells<const BLOCKED: bool>(
        occupied: *const u64,
        blocked: *const u64,
        index: usize,
    ) -> Cells {
        unsafe {
            let occupied = spread(*occupied.cast::<u32>().add(index));
            let lost = if BLOCKED {
                _mm256_or_si256(occupied, spread(*blocked.cast::<u32>().add(index)))
            } else {
                occupied
            };
            Cells {
                open: _mm256_xor_si256(lost, _mm256_set1_epi8(-1)),
                occupied,
            }
        }
    }

    #[inline(always)]
    unsafe fn step<const BLOCKED: bool>(self, cells: Cells, end: Self) -> Self {
        unsafe {
            let next = _mm256_subs_epu8(self.0, _mm256_set1_epi8(1));
            let end = _mm256_and_si256(end.0, cells.occupied);
            Avx2(if BLOCKED {
                _mm256_or_si256(_mm256_and_si256(next, cells.open), end)
            } else {
                // Nothing ahead has more left than an obstacle.
                _mm256_max_epu8(next, end)
            })
        }
    }

    #[inline(always)]
    unsafe fn splat_pair(numbers: u32) -> Self::Pair {
        unsafe {
            let both = _mm256_set1_epi32(numbers as i32);
            (both, both)
        }
    }

    #[inline(always)]
    unsafe fn load_pair(from: *const u16) -> Self::Pair {
        unsafe {
            (
                _mm256_loadu_si256(from.cast()),
                _mm256_loadu_si256(from.add(16).cast()),
            )
        }
    }

    #[inline(always)]
    unsafe fn store_pair(pair: Self::Pair, to: *mut u16) {
        unsafe {
            _mm256_storeu_si256(to.cast(), pair.0);
            _mm256_storeu_si256(to.add(16).cast(), pair.1);
        }
    }

    #[inline(always)]
    unsafe fn step_pair<const BLOCKED: bool>(
        pair: Self::Pair,
        cells: Cells,
        end: Self::Pair,
    ) -> Self::Pair {
        unsafe {
            let step = |ahead, end, occupied, open| {
                let next = _mm256_subs_epu16(ahead, _mm256_set1_epi16(1));
                let end = _mm256_and_si256(end, _mm256_cvtepi8_epi16(occupied));
                if BLOCKED {
                    _mm256_or_si256(_mm256_and_si256(next, _mm256_cvtepi8_epi16(open)), end)
                } else {
                    _mm256_max_epu16(next, end)
                }
            };
            let low = |bytes| _mm256_castsi256_si128(bytes);
            let high = |bytes| _mm256_extracti128_si256::<1>(bytes);
            let Cells { open, occupied } = cells;
            (
                step(pair.0, end.0, low(occupied), low(open)),
                step(pair.1, end.1, high(occupied), high(open)),
            )
        }
    }

    #[inline(always)]
    unsafe fn narrow(pair: Self::Pair) -> Self {
        unsafe {
            let packed = _mm256_packus_epi16(pair.0, pair.1);
            Avx2(_mm256_permute4x64_epi64::<0b11_01_10_00>(packed))
        }
    }

    fn lookup(taper: &Taper<'_>, highest: u8) -> Lookup {
        if highest < 16 {
            return Lookup::by_left(SHORT, taper, 16);
        }
        if 2 * taper.profile.len() < 16 {
            return Lookup::by_left(CLAMPED, taper, 16);
        }
        let mut lookup = Lookup::new(BY_DISTANCE, taper);
        lookup.bytes[..taper.profile.len()].copy_from_slice(taper.profile);
        lookup.parts = taper.profile.len().div_ceil(16) as u8;
        lookup
    }

    #[inline(always)]
    unsafe fn vote<const N: usize>(votes: &mut [Self; N], left: &[Self; N], lookup: &Lookup) {
        unsafe {
            let part = |i: usize| {
                let from = lookup.bytes.as_ptr().add(16 * i);
                _mm256_broadcastsi128_si256(_mm_load_si128(from.cast()))
            };
            let first = part(0);
            match lookup.kind {
                SHORT => {
                    for i in 0..N {
                        let found = _mm256_shuffle_epi8(first, left[i].0);
                        votes[i] = votes[i].add(Avx2(found));
                    }
                }
                CLAMPED => {
                    for i in 0..N {
                        let index = _mm256_min_epu8(left[i].0, _mm256_set1_epi8(15));
                        let found = _mm256_shuffle_epi8(first, index);
                        votes[i] = votes[i].add(Avx2(found));
                    }
                }
                _ => {
                    // What is left differs from the reach by at most 255 less
                    // the reach: the distance may wrap, but not to a vote.
                    let reach = _mm256_set1_epi8(lookup.reach as i8);
                    let beyond = _mm256_set1_epi8(BEYOND);
                    let mut distance = [_mm256_setzero_si256(); N];
                    for i in 0..N {
                        distance[i] = _mm256_abs_epi8(_mm256_sub_epi8(left[i].0, reach));
                        let index = _mm256_adds_epu8(distance[i], beyond);
                        let found = _mm256_shuffle_epi8(first, index);
                        votes[i] = votes[i].add(Avx2(found));
                    }
                    for j in 1..usize::from(lookup.parts) {
                        let (table, start) = (part(j), _mm256_set1_epi8(16 * j as i8));
                        for i in 0..N {
                            let index = _mm256_sub_epi8(distance[i], start);
                            let index = _mm256_adds_epu8(index, beyond);
                            let found = _mm256_shuffle_epi8(table, index);
                            votes[i] = votes[i].add(Avx2(found));
                        }
                    }
                }
            }
        }
    }
}

/// All ones in the bytes whose bit is set.
#[inline(always)]
unsafe fn spread(bits: u32) -> __m256i {
    unsafe {
        let byte_of = _mm256_setr_epi64x(
            0,
            0x0101_0101_0101_0101,
            0x0202_0202_0202_0202,
            0x0303_0303_0303_0303,
        );
        let bit_of = _mm256_set1_epi64x(0x8040_2010_0804_0201_u64 as i64);
        let bytes = _mm256_shuffle_epi8(_mm256_set1_epi32(bits as i32), byte_of);
        _mm256_cmpeq_epi8(_mm256_and_si256(bytes, bit_of), bit_of)
    }
}
