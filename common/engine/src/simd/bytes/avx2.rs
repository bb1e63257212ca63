//! 32 bytes with AVX2: a look-up takes one instruction for 16 entries, and as
//! tapers are symmetric, 16 entries hold the distances on both sides.

use std::arch::x86_64::*;

use bytemuck::must_cast;

use super::{ENOUGH, Lanes, Lookup};
use crate::program::Taper;
use crate::simd::table::BEYOND;
use crate::simd::{Avx2, avx2};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Avx2Bytes(__m256i);

/// Masks with all ones in the bytes of open and of occupied cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cells {
    open: __m256i,
    occupied: __m256i,
}

/// Kind of look-up in which at most 15 steps are left.
const SHORT: u8 = 0;
/// Kind of look-up in which votes end before 15 steps are left.
const CLAMPED: u8 = 1;
/// Kind of look-up by the distance from the reading, in parts of 16.
const BY_DISTANCE: u8 = 2;

avx2! {
    /// Returns all ones in the bytes whose bit is set.
    fn spread(_set: Avx2, bits: u32) -> __m256i {
        let byte_of = _mm256_setr_epi64x(
            0,
            0x0101_0101_0101_0101,
            0x0202_0202_0202_0202,
            0x0303_0303_0303_0303,
        );
        let bit_of = _mm256_set1_epi64x(0x8040_2010_0804_0201_u64.cast_signed());
        let bytes = _mm256_shuffle_epi8(_mm256_set1_epi32(bits.cast_signed()), byte_of);
        _mm256_cmpeq_epi8(_mm256_and_si256(bytes, bit_of), bit_of)
    }
}

avx2! {
    impl Lanes for Avx2Bytes {
        type Set = Avx2;
        type Pair = [__m256i; 2];
        type Cells = Cells;
        const WIDTH: usize = 32;
        const AT_A_TIME: usize = 3;

        fn splat(_set: Avx2, byte: u8) -> Avx2Bytes {
            Avx2Bytes(_mm256_set1_epi8(byte.cast_signed()))
        }

        fn load(_set: Avx2, from: &[u8]) -> Avx2Bytes {
            Avx2Bytes(must_cast(*from.first_chunk::<32>().expect(ENOUGH)))
        }

        fn store(self, to: &mut [u8]) {
            *to.first_chunk_mut::<32>().expect(ENOUGH) = must_cast(self.0);
        }

        fn add(self, other: Avx2Bytes) -> Avx2Bytes {
            Avx2Bytes(_mm256_add_epi8(self.0, other.0))
        }

        fn widen<const ADD: bool>(self, to: &mut [u16]) {
            let to = to.first_chunk_mut::<32>().expect(ENOUGH);
            let mut numbers = [
                _mm256_cvtepu8_epi16(_mm256_castsi256_si128(self.0)),
                _mm256_cvtepu8_epi16(_mm256_extracti128_si256::<1>(self.0)),
            ];
            if ADD {
                let [low, high]: [__m256i; 2] = must_cast(*to);
                numbers = [_mm256_add_epi16(numbers[0], low), _mm256_add_epi16(numbers[1], high)];
            }
            *to = must_cast(numbers);
        }

        fn cells<const BLOCKED: bool>(set: Avx2, occupied: u64, blocked: u64) -> Cells {
            let occupied = spread(set, occupied as u32);
            let lost = if BLOCKED {
                _mm256_or_si256(occupied, spread(set, blocked as u32))
            } else {
                occupied
            };
            Cells {
                open: _mm256_xor_si256(lost, _mm256_set1_epi8(-1)),
                occupied,
            }
        }

        fn step<const BLOCKED: bool>(self, cells: Cells, end: Avx2Bytes) -> Avx2Bytes {
            let next = _mm256_subs_epu8(self.0, _mm256_set1_epi8(1));
            let end = _mm256_and_si256(end.0, cells.occupied);
            Avx2Bytes(if BLOCKED {
                _mm256_or_si256(_mm256_and_si256(next, cells.open), end)
            } else {
                // Nothing ahead has more steps left than an obstacle.
                _mm256_max_epu8(next, end)
            })
        }

        fn splat_pair(_set: Avx2, number: u16) -> [__m256i; 2] {
            [_mm256_set1_epi16(number.cast_signed()); 2]
        }

        fn load_pair(_set: Avx2, from: &[u8]) -> [__m256i; 2] {
            must_cast(*from.first_chunk::<64>().expect(ENOUGH))
        }

        fn store_pair(_set: Avx2, pair: [__m256i; 2], to: &mut [u8]) {
            *to.first_chunk_mut::<64>().expect(ENOUGH) = must_cast(pair);
        }

        fn step_pair<const BLOCKED: bool>(
            _set: Avx2,
            pair: [__m256i; 2],
            cells: Cells,
            end: [__m256i; 2],
        ) -> [__m256i; 2] {
            let mut stepped = pair;
            let occupied: [__m128i; 2] = must_cast(cells.occupied);
            let open: [__m128i; 2] = must_cast(cells.open);
            for half in 0..2 {
                let next = _mm256_subs_epu16(pair[half], _mm256_set1_epi16(1));
                let end = _mm256_and_si256(end[half], _mm256_cvtepi8_epi16(occupied[half]));
                stepped[half] = if BLOCKED {
                    let open = _mm256_cvtepi8_epi16(open[half]);
                    _mm256_or_si256(_mm256_and_si256(next, open), end)
                } else {
                    _mm256_max_epu16(next, end)
                };
            }
            stepped
        }

        fn narrow(_set: Avx2, pair: [__m256i; 2]) -> Avx2Bytes {
            let packed = _mm256_packus_epi16(pair[0], pair[1]);
            Avx2Bytes(_mm256_permute4x64_epi64::<0b11_01_10_00>(packed))
        }

        fn lookup(_set: Avx2, taper: &Taper<'_>, highest: u8) -> Lookup {
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

        plain {
            #[inline(always)]
            fn vote<const N: usize>(
                set: Avx2,
                votes: &mut [Self; N],
                left: &[Self; N],
                lookup: &Lookup,
            ) {
                let mut parts = lookup.bytes.as_chunks().0.iter();
                let mut part = || Some(part(set, parts.next()?));
                let Some(first) = part() else { return };
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
                    _ => {
                        let mut distances = *left;
                        let reach = <Self as Lanes>::splat(set, lookup.reach);
                        for (votes, distance) in votes.iter_mut().zip(&mut distances) {
                            *distance = from(*distance, reach);
                            *votes = Lanes::add(*votes, within(*distance, first));
                        }
                        for i in 1..lookup.parts {
                            let (Some(part), start) = (part(), <Self as Lanes>::splat(set, 16 * i)) else {
                                return;
                            };
                            for (votes, &distance) in votes.iter_mut().zip(&distances) {
                                *votes = Lanes::add(*votes, within(less(distance, start), part));
                            }
                        }
                    }
                }
            }
        }
    }
}

avx2! {
    /// Returns sixteen bytes of a look-up, twice.
    fn part(_set: Avx2, bytes: &[u8; 16]) -> Avx2Bytes {
        Avx2Bytes(_mm256_broadcastsi128_si256(must_cast(*bytes)))
    }
}

avx2! {
    /// Looks up bytes of a table at places below 16.
    fn short(left: Avx2Bytes, table: Avx2Bytes) -> Avx2Bytes {
        Avx2Bytes(_mm256_shuffle_epi8(table.0, left.0))
    }
}

avx2! {
    /// Looks up bytes of a table; places beyond its end give the last one.
    fn clamped(left: Avx2Bytes, table: Avx2Bytes) -> Avx2Bytes {
        short(Avx2Bytes(_mm256_min_epu8(left.0, _mm256_set1_epi8(15))), table)
    }
}

avx2! {
    /// Looks up bytes of a table; places beyond its end give 0.
    fn within(distance: Avx2Bytes, table: Avx2Bytes) -> Avx2Bytes {
        short(Avx2Bytes(_mm256_adds_epu8(distance.0, _mm256_set1_epi8(BEYOND))), table)
    }
}

avx2! {
    /// Returns the distances of bytes from the reach. Bytes exceed the reach by at most 255
    /// less the reach: the distance may wrap, but not to a vote.
    fn from(left: Avx2Bytes, reach: Avx2Bytes) -> Avx2Bytes {
        Avx2Bytes(_mm256_abs_epi8(less(left, reach).0))
    }
}

avx2! {
    fn less(a: Avx2Bytes, b: Avx2Bytes) -> Avx2Bytes {
        Avx2Bytes(_mm256_sub_epi8(a.0, b.0))
    }
}
