//! 64 bytes with AVX-512: a look-up of 64 cells is one instruction.

use std::arch::x86_64::*;

use bytemuck::must_cast;

use super::{ENOUGH, Lanes, Lookup};
use crate::program::Taper;
use crate::simd::{Avx512, avx512};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx512Bytes(__m512i);

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

avx512! {
    impl Lanes for Avx512Bytes {
        type Set = Avx512;
        type Pair = [__m512i; 2];
        type Cells = Cells;
        const WIDTH: usize = 64;
        const AT_A_TIME: usize = 5;

        fn splat(_set: Avx512, byte: u8) -> Avx512Bytes {
            Avx512Bytes(_mm512_set1_epi8(byte.cast_signed()))
        }

        fn load(_set: Avx512, from: &[u8]) -> Avx512Bytes {
            Avx512Bytes(must_cast(*from.first_chunk::<64>().expect(ENOUGH)))
        }

        fn store(self, to: &mut [u8]) {
            *to.first_chunk_mut::<64>().expect(ENOUGH) = must_cast(self.0);
        }

        fn add(self, other: Avx512Bytes) -> Avx512Bytes {
            Avx512Bytes(_mm512_add_epi8(self.0, other.0))
        }

        fn widen<const ADD: bool>(self, to: &mut [u16]) {
            let to = to.first_chunk_mut::<64>().expect(ENOUGH);
            let mut numbers = [
                _mm512_cvtepu8_epi16(_mm512_castsi512_si256(self.0)),
                _mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64::<1>(self.0)),
            ];
            if ADD {
                let [low, high]: [__m512i; 2] = must_cast(*to);
                numbers = [_mm512_add_epi16(numbers[0], low), _mm512_add_epi16(numbers[1], high)];
            }
            *to = must_cast(numbers);
        }

        fn cells<const BLOCKED: bool>(_set: Avx512, occupied: u64, blocked: u64) -> Cells {
            let blocked = if BLOCKED { blocked } else { 0 };
            Cells {
                open: !(occupied | blocked),
                occupied,
            }
        }

        fn step<const BLOCKED: bool>(self, cells: Cells, end: Avx512Bytes) -> Avx512Bytes {
            let end = if BLOCKED {
                _mm512_maskz_mov_epi8(cells.occupied, end.0)
            } else {
                end.0
            };
            Avx512Bytes(_mm512_mask_subs_epu8(end, cells.open, self.0, _mm512_set1_epi8(1)))
        }

        fn splat_pair(_set: Avx512, number: u16) -> [__m512i; 2] {
            [_mm512_set1_epi16(number.cast_signed()); 2]
        }

        fn load_pair(_set: Avx512, from: &[u8]) -> [__m512i; 2] {
            must_cast(*from.first_chunk::<128>().expect(ENOUGH))
        }

        fn store_pair(_set: Avx512, pair: [__m512i; 2], to: &mut [u8]) {
            *to.first_chunk_mut::<128>().expect(ENOUGH) = must_cast(pair);
        }

        fn step_pair<const BLOCKED: bool>(
            _set: Avx512,
            pair: [__m512i; 2],
            cells: Cells,
            end: [__m512i; 2],
        ) -> [__m512i; 2] {
            let (mut stepped, one) = (pair, _mm512_set1_epi16(1));
            for half in 0..2 {
                let occupied = (cells.occupied >> (32 * half)) as u32;
                let open = (cells.open >> (32 * half)) as u32;
                let end = if BLOCKED {
                    _mm512_maskz_mov_epi16(occupied, end[half])
                } else {
                    end[half]
                };
                stepped[half] = _mm512_mask_subs_epu16(end, open, pair[half], one);
            }
            stepped
        }

        fn narrow(_set: Avx512, pair: [__m512i; 2]) -> Avx512Bytes {
            let order = _mm512_setr_epi64(0, 2, 4, 6, 1, 3, 5, 7);
            let packed = _mm512_packus_epi16(pair[0], pair[1]);
            Avx512Bytes(_mm512_permutexvar_epi64(order, packed))
        }

        fn lookup(_set: Avx512, taper: &Taper<'_>, highest: u8) -> Lookup {
            let votes_end = 2 * taper.profile.len();
            let (kind, size) = match votes_end {
                _ if highest < 64 => (SHORT, 64),
                ..64 => (CLAMPED, 64),
                64..128 => (DOUBLE, 128),
                _ => (FULL, 256),
            };
            Lookup::by_left(kind, taper, size)
        }

        plain {
            #[inline(always)]
            fn vote<const N: usize>(
                set: Avx512,
                votes: &mut [Self; N],
                left: &[Self; N],
                lookup: &Lookup,
            ) {
                let part = |i: usize| <Self as Lanes>::load(set, &lookup.bytes[64 * i..]);
                let first = part(0);
                match lookup.kind {
                    SHORT => {
                        for (votes, &left) in votes.iter_mut().zip(left) {
                            *votes = Lanes::add(*votes, short(left, first));
                        }
                    }
                    CLAMPED => {
                        for (votes, &left) in votes.iter_mut().zip(left) {
                            *votes = Lanes::add(*votes, clamped(left, first));
                        }
                    }
                    DOUBLE => {
                        let second = part(1);
                        for (votes, &left) in votes.iter_mut().zip(left) {
                            *votes = Lanes::add(*votes, double(left, first, second));
                        }
                    }
                    _ => {
                        let (second, third, fourth) = (part(1), part(2), part(3));
                        for (votes, &left) in votes.iter_mut().zip(left) {
                            *votes = Lanes::add(*votes, full(left, [first, second, third, fourth]));
                        }
                    }
                }
            }
        }
    }
}

avx512! {
    /// The bytes of a table at places below 64.
    fn short(left: Avx512Bytes, table: Avx512Bytes) -> Avx512Bytes {
        Avx512Bytes(_mm512_permutexvar_epi8(left.0, table.0))
    }
}

avx512! {
    /// The same; beyond the table it is as at its end.
    fn clamped(left: Avx512Bytes, table: Avx512Bytes) -> Avx512Bytes {
        short(Avx512Bytes(_mm512_min_epu8(left.0, _mm512_set1_epi8(63))), table)
    }
}

avx512! {
    /// The same by a table of two parts.
    fn double(left: Avx512Bytes, first: Avx512Bytes, second: Avx512Bytes) -> Avx512Bytes {
        let index = _mm512_min_epu8(left.0, _mm512_set1_epi8(127));
        Avx512Bytes(_mm512_permutex2var_epi8(first.0, index, second.0))
    }
}

avx512! {
    /// The bytes of a table of four parts.
    fn full(left: Avx512Bytes, parts: [Avx512Bytes; 4]) -> Avx512Bytes {
        let [first, second, third, fourth] = parts;
        let low = _mm512_permutex2var_epi8(first.0, left.0, second.0);
        let high = _mm512_permutex2var_epi8(third.0, left.0, fourth.0);
        Avx512Bytes(_mm512_mask_mov_epi8(low, _mm512_movepi8_mask(left.0), high))
    }
}
