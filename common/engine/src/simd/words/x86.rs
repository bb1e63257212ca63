//! Words in the registers of AVX2.

use std::arch::x86_64::*;

use bytemuck::must_cast;

use super::{BYTES, BitWords, Words};
use crate::simd::{Avx2, avx2};

/// In each half of a register, four bytes of each block one after the other.
const BY_BLOCKS: [u8; 16] = [0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15];

/// Two registers of AVX2.
#[derive(Clone, Copy)]
pub(crate) struct Avx2Words([__m256i; 2]);

/// For each mask of eight, the number of selected places before each place, as a byte.
static PLACES: [u64; 256] = places();

const fn places() -> [u64; 256] {
    let mut places = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut i, mut next) = (0, 0);
        while i < 8 {
            places[mask] |= next << (8 * i);
            next += mask as u64 >> i & 1;
            i += 1;
        }
        mask += 1;
    }
    places
}

avx2! {
    /// Spreads eight groups of four bytes: places that the mask selects get the next group of
    /// `bytes`, others get no bits.
    fn expand(_set: Avx2, mask: u8, bytes: &[u8; BYTES / 2]) -> __m256i {
        let places = _mm_cvtsi64_si128(PLACES[usize::from(mask)].cast_signed());
        let spread = _mm256_permutevar8x32_epi32(must_cast(*bytes), _mm256_cvtepu8_epi32(places));
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        let set = _mm256_and_si256(_mm256_set1_epi32(i32::from(mask)), bits);
        _mm256_and_si256(spread, _mm256_cmpeq_epi32(set, bits))
    }
}

avx2! {
    impl BitWords for Avx2Words {
        type Set = Avx2;

        fn empty(_set: Avx2) -> Avx2Words {
            Avx2Words([_mm256_setzero_si256(); 2])
        }

        fn splat(_set: Avx2, word: u128) -> Avx2Words {
            let halves = [word as u64, (word >> 64) as u64];
            Avx2Words(halves.map(|half| _mm256_set1_epi64x(half.cast_signed())))
        }

        fn read(_set: Avx2, bytes: &[u8; BYTES]) -> Avx2Words {
            Avx2Words(must_cast(*bytes))
        }

        fn expand(set: Avx2, mask: u16, bytes: &[u8; BYTES]) -> Avx2Words {
            let [low, high] = mask.to_le_bytes();
            let half = |from: usize| bytes[from..].first_chunk().expect("half of them");
            let rest = 4 * low.count_ones() as usize;
            Avx2Words([expand(set, low, half(0)), expand(set, high, half(rest))])
        }

        fn from_words(_set: Avx2, words: &Words) -> Avx2Words {
            Avx2Words(must_cast(*words))
        }

        fn to_words(self) -> Words {
            must_cast(self.0)
        }

        fn and(self, other: Avx2Words) -> Avx2Words {
            let ([low, high], [other_low, other_high]) = (self.0, other.0);
            Avx2Words([_mm256_and_si256(low, other_low), _mm256_and_si256(high, other_high)])
        }

        fn or(self, other: Avx2Words) -> Avx2Words {
            let ([low, high], [other_low, other_high]) = (self.0, other.0);
            Avx2Words([_mm256_or_si256(low, other_low), _mm256_or_si256(high, other_high)])
        }

        fn without(self, other: Avx2Words) -> Avx2Words {
            let ([low, high], [other_low, other_high]) = (self.0, other.0);
            Avx2Words([_mm256_andnot_si256(other_low, low), _mm256_andnot_si256(other_high, high)])
        }

        fn full_adder(self, b: Avx2Words, c: Avx2Words) -> (Avx2Words, Avx2Words) {
            let (mut sums, mut carries) = (self.0, self.0);
            for half in 0..2 {
                let (a, b, c) = (self.0[half], b.0[half], c.0[half]);
                let odd = _mm256_xor_si256(a, b);
                sums[half] = _mm256_xor_si256(odd, c);
                let both = _mm256_and_si256(a, b);
                carries[half] = _mm256_or_si256(both, _mm256_and_si256(odd, c));
            }
            (Avx2Words(sums), Avx2Words(carries))
        }

        fn shift_down(self, by: u32) -> Avx2Words {
            let [low, high] = self.0;
            let down = _mm_cvtsi32_si128(by as i32);
            let up = _mm_cvtsi32_si128(64 - by as i32);
            let (low, next) = (_mm256_srl_epi64(low, down), _mm256_sll_epi64(high, up));
            Avx2Words([_mm256_or_si256(low, next), _mm256_srl_epi64(high, down)])
        }

        fn filled(self) -> Avx2Words {
            let halves = _mm256_or_si256(self.0[0], self.0[1]);
            let without = _mm256_cmpeq_epi64(halves, _mm256_setzero_si256());
            Avx2Words([_mm256_xor_si256(without, _mm256_set1_epi64x(-1)); 2])
        }

        fn sorted(self) -> Avx2Words {
            // After this, the parts of each block are adjacent.
            let bytes = _mm256_broadcastsi128_si256(must_cast(BY_BLOCKS));
            let order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
            let [low, high] = self.0;
            Avx2Words([
                _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(low, bytes), order),
                _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(high, bytes), order),
            ])
        }

        fn is_empty(self) -> bool {
            let all = _mm256_or_si256(self.0[0], self.0[1]);
            _mm256_testz_si256(all, all) == 1
        }
    }
}
