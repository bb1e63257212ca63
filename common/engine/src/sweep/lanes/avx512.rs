//! 64 bytes with AVX-512: a look-up of 64 cells is one instruction.

use std::arch::x86_64::*;

use super::{Lanes, Lookup};
use crate::program::Taper;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx512(__m512i);

/// One bit a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    open: u64,
    occupied: u64,
}

/// What is left is never above 63.
const SHORT: u8 = 0;
/// Votes end before 63 are left.
const CLAMPED: u8 = 1;
/// Votes end before 127 are left.
const DOUBLE: u8 = 2;
const FULL: u8 = 3;

impl Lanes for Avx512 {
    const WIDTH: usize = 64;
    type Pair = (__m512i, __m512i);
    type Cells = Cells;

    #[inline(always)]
    unsafe fn zero() -> Self {
        unsafe { Avx512(_mm512_setzero_si512()) }
    }

    #[inline(always)]
    unsafe fn splat(bytes: u32) -> Self {
        unsafe { Avx512(_mm512_set1_epi32(bytes as i32)) }
    }

    #[inline(always)]
    unsafe fn load(from: *const u8) -> Self {
        unsafe { Avx512(_mm512_loadu_si512(from.cast())) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut u8) {
        unsafe { _mm512_storeu_si512(to.cast(), self.0) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe { Avx512(_mm512_add_epi8(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn widen<const ADD: bool>(self, to: *mut u16) {
        unsafe {
            let halves = [
                _mm512_castsi512_si256(self.0),
                _mm512_extracti64x4_epi64::<1>(self.0),
            ];
            for (i, half) in halves.into_iter().enumerate() {
                let to = to.add(32 * i);
                let mut numbers = _mm512_cvtepu8_epi16(half);
                if ADD {
                    numbers = _mm512_add_epi16(numbers, _mm512_loadu_si512(to.cast()));
                }
                _mm512_storeu_si512(to.cast(), numbers);
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
            let occupied = *occupied.add(index);
            let blocked = if BLOCKED { *blocked.add(index) } else { 0 };
            Cells {
                open: !(occupied | blocked),
                occupied,
            }
        }
    }

    #[inline(always)]
    unsafe fn step<const BLOCKED: bool>(self, cells: Cells, end: Self) -> Self {
        unsafe {
            let end = if BLOCKED {
                _mm512_maskz_mov_epi8(cells.occupied, end.0)
            } else {
                end.0
            };
            Avx512(_mm512_mask_subs_epu8(
                end,
                cells.open,
                self.0,
                _mm512_set1_epi8(1),
            ))
        }
    }

    #[inline(always)]
    unsafe fn splat_pair(numbers: u32) -> Self::Pair {
        unsafe {
            let both = _mm512_set1_epi32(numbers as i32);
            (both, both)
        }
    }

    #[inline(always)]
    unsafe fn load_pair(from: *const u16) -> Self::Pair {
        unsafe {
            (
                _mm512_loadu_si512(from.cast()),
                _mm512_loadu_si512(from.add(32).cast()),
            )
        }
    }

    #[inline(always)]
    unsafe fn store_pair(pair: Self::Pair, to: *mut u16) {
        unsafe {
            _mm512_storeu_si512(to.cast(), pair.0);
            _mm512_storeu_si512(to.add(32).cast(), pair.1);
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
                let end = if BLOCKED {
                    _mm512_maskz_mov_epi16(occupied, end)
                } else {
                    end
                };
                _mm512_mask_subs_epu16(end, open, ahead, _mm512_set1_epi16(1))
            };
            let Cells { open, occupied } = cells;
            (
                step(pair.0, end.0, occupied as u32, open as u32),
                step(pair.1, end.1, (occupied >> 32) as u32, (open >> 32) as u32),
            )
        }
    }

    #[inline(always)]
    unsafe fn narrow(pair: Self::Pair) -> Self {
        unsafe {
            let order = _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7);
            let packed = _mm512_packus_epi16(pair.0, pair.1);
            Avx512(_mm512_permutexvar_epi64(order, packed))
        }
    }

    fn lookup(taper: &Taper<'_>, highest: u8) -> Lookup {
        let votes_end = 2 * taper.profile.len();
        let (kind, size) = match votes_end {
            _ if highest < 64 => (SHORT, 64),
            ..64 => (CLAMPED, 64),
            64..128 => (DOUBLE, 128),
            _ => (FULL, 256),
        };
        Lookup::by_left(kind, taper, size)
    }

    #[inline(always)]
    unsafe fn vote<const N: usize>(votes: &mut [Self; N], left: &[Self; N], lookup: &Lookup) {
        unsafe {
            let part = |i: usize| _mm512_load_si512(lookup.bytes.as_ptr().add(64 * i).cast());
            let first = part(0);
            match lookup.kind {
                SHORT => {
                    for i in 0..N {
                        let found = _mm512_permutexvar_epi8(left[i].0, first);
                        votes[i] = votes[i].add(Avx512(found));
                    }
                }
                CLAMPED => {
                    for i in 0..N {
                        let index = _mm512_min_epu8(left[i].0, _mm512_set1_epi8(63));
                        let found = _mm512_permutexvar_epi8(index, first);
                        votes[i] = votes[i].add(Avx512(found));
                    }
                }
                DOUBLE => {
                    let second = part(1);
                    for i in 0..N {
                        let index = _mm512_min_epu8(left[i].0, _mm512_set1_epi8(127));
                        let found = _mm512_permutex2var_epi8(first, index, second);
                        votes[i] = votes[i].add(Avx512(found));
                    }
                }
                _ => {
                    let (second, third, fourth) = (part(1), part(2), part(3));
                    for i in 0..N {
                        let index = left[i].0;
                        let low = _mm512_permutex2var_epi8(first, index, second);
                        let high = _mm512_permutex2var_epi8(third, index, fourth);
                        let found = _mm512_mask_mov_epi8(low, _mm512_movepi8_mask(index), high);
                        votes[i] = votes[i].add(Avx512(found));
                    }
                }
            }
        }
    }
}
