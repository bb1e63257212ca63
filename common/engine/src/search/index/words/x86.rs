//! Words in the registers of AVX-512 and AVX2.

#![expect(
    clippy::undocumented_unsafe_blocks,
    reason = "one argument holds for all: words of an instruction set are made only where the \
              processor has it, and all that is read or written are the 64 bytes of a quad"
)]

use std::arch::x86_64::*;

use super::{BYTES, BitWords, EMPTY, Words};

/// In each half of a register, four bytes of each block one after the other.
const BY_BLOCKS: [i8; 16] = [0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15];

/// What AVX-512 holds in one register.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512i);

impl BitWords for Avx512 {
    const AT_A_TIME: usize = 3;

    #[inline(always)]
    fn empty() -> Self {
        unsafe { Avx512(_mm512_setzero_si512()) }
    }

    #[inline(always)]
    fn splat(word: u128) -> Self {
        unsafe {
            let low = _mm512_set1_epi64((word as u64).cast_signed());
            let high = ((word >> 64) as u64).cast_signed();
            Avx512(_mm512_mask_set1_epi64(low, 0xf0, high))
        }
    }

    #[inline(always)]
    fn read(bytes: &[u8; BYTES]) -> Self {
        unsafe { Avx512(_mm512_loadu_si512(bytes.as_ptr().cast())) }
    }

    #[inline(always)]
    fn expand(mask: u16, bytes: &[u8; BYTES]) -> Self {
        unsafe {
            let packed = _mm512_loadu_si512(bytes.as_ptr().cast());
            Avx512(_mm512_maskz_expand_epi32(mask, packed))
        }
    }

    #[inline(always)]
    fn from_words(words: &Words) -> Self {
        unsafe { Avx512(_mm512_loadu_si512(words.as_ptr().cast())) }
    }

    #[inline(always)]
    fn to_words(self) -> Words {
        let mut words = EMPTY;
        unsafe { _mm512_storeu_si512(words.as_mut_ptr().cast(), self.0) };
        words
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        unsafe { Avx512(_mm512_and_si512(self.0, other.0)) }
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        unsafe { Avx512(_mm512_or_si512(self.0, other.0)) }
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        unsafe { Avx512(_mm512_andnot_si512(other.0, self.0)) }
    }

    #[inline(always)]
    fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        // The truth tables of the odd number of bits and of the majority.
        unsafe {
            (
                Avx512(_mm512_ternarylogic_epi64::<0x96>(self.0, b.0, c.0)),
                Avx512(_mm512_ternarylogic_epi64::<0xe8>(self.0, b.0, c.0)),
            )
        }
    }

    #[inline(always)]
    fn shift_down(self, by: u32) -> Self {
        unsafe {
            let next = _mm512_alignr_epi64::<4>(_mm512_setzero_si512(), self.0);
            let low = _mm512_srl_epi64(self.0, _mm_cvtsi32_si128(by as i32));
            let high = _mm512_sll_epi64(next, _mm_cvtsi32_si128(64 - by as i32));
            Avx512(_mm512_or_si512(low, high))
        }
    }

    #[inline(always)]
    fn filled(self) -> Self {
        unsafe {
            let halves = _mm512_or_si512(self.0, _mm512_alignr_epi64::<4>(self.0, self.0));
            let any = _mm512_test_epi64_mask(halves, halves);
            Avx512(_mm512_maskz_set1_epi64(any, -1))
        }
    }

    #[inline(always)]
    fn sorted(self) -> Self {
        unsafe {
            // Then the parts of each block side by side, half by half.
            let bytes = _mm_loadu_si128(BY_BLOCKS.as_ptr().cast());
            let parts = _mm512_shuffle_epi8(self.0, _mm512_broadcast_i32x4(bytes));
            let order = _mm512_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 10, 14, 11, 15);
            Avx512(_mm512_permutexvar_epi32(order, parts))
        }
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        unsafe { _mm512_test_epi64_mask(self.0, self.0) == 0 }
    }
}

/// Two registers of AVX2.
#[derive(Clone, Copy)]
pub(crate) struct Avx2([__m256i; 2]);

impl Avx2 {
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(__m256i, __m256i) -> __m256i) -> Self {
        Avx2([op(self.0[0], other.0[0]), op(self.0[1], other.0[1])])
    }
}

/// For each mask of eight, which of those that it tells comes where.
static PLACES: [[u8; 8]; 256] = places();

const fn places() -> [[u8; 8]; 256] {
    let mut places = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut i, mut next) = (0, 0);
        while i < 8 {
            places[mask][i] = next;
            next += (mask >> i & 1) as u8;
            i += 1;
        }
        mask += 1;
    }
    places
}

/// Eight times four bytes: those that the mask tells, one after the other, and
/// others without bits.
///
/// # Safety
/// The processor must have AVX2, and 32 bytes be there.
#[inline(always)]
unsafe fn expand(mask: u8, bytes: *const u8) -> __m256i {
    unsafe {
        let places = _mm_loadl_epi64(PLACES[usize::from(mask)].as_ptr().cast());
        let packed = _mm256_loadu_si256(bytes.cast());
        let spread = _mm256_permutevar8x32_epi32(packed, _mm256_cvtepu8_epi32(places));
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        let told = _mm256_and_si256(_mm256_set1_epi32(i32::from(mask)), bits);
        _mm256_and_si256(spread, _mm256_cmpeq_epi32(told, bits))
    }
}

impl BitWords for Avx2 {
    const AT_A_TIME: usize = 1;

    #[inline(always)]
    fn empty() -> Self {
        unsafe { Avx2([_mm256_setzero_si256(); 2]) }
    }

    #[inline(always)]
    fn splat(word: u128) -> Self {
        unsafe {
            let (low, high) = (word as u64, (word >> 64) as u64);
            Avx2([
                _mm256_set1_epi64x(low.cast_signed()),
                _mm256_set1_epi64x(high.cast_signed()),
            ])
        }
    }

    #[inline(always)]
    fn read(bytes: &[u8; BYTES]) -> Self {
        unsafe {
            Avx2([
                _mm256_loadu_si256(bytes.as_ptr().cast()),
                _mm256_loadu_si256(bytes.as_ptr().add(BYTES / 2).cast()),
            ])
        }
    }

    #[inline(always)]
    fn expand(mask: u16, bytes: &[u8; BYTES]) -> Self {
        let [low, high] = mask.to_le_bytes();
        unsafe {
            let rest = bytes.as_ptr().add(4 * low.count_ones() as usize);
            Avx2([expand(low, bytes.as_ptr()), expand(high, rest)])
        }
    }

    #[inline(always)]
    fn from_words(words: &Words) -> Self {
        unsafe {
            Avx2([
                _mm256_loadu_si256(words[0].as_ptr().cast()),
                _mm256_loadu_si256(words[1].as_ptr().cast()),
            ])
        }
    }

    #[inline(always)]
    fn to_words(self) -> Words {
        let mut words = EMPTY;
        unsafe {
            _mm256_storeu_si256(words[0].as_mut_ptr().cast(), self.0[0]);
            _mm256_storeu_si256(words[1].as_mut_ptr().cast(), self.0[1]);
        }
        words
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_and_si256(a, b) })
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_or_si256(a, b) })
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_andnot_si256(b, a) })
    }

    #[inline(always)]
    fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        let xor = |a: Self, b: Self| a.zip(b, |a, b| unsafe { _mm256_xor_si256(a, b) });
        let odd = xor(self, b);
        (xor(odd, c), self.and(b).or(odd.and(c)))
    }

    #[inline(always)]
    fn shift_down(self, by: u32) -> Self {
        unsafe {
            let [low, high] = self.0;
            let (down, up) = (
                _mm_cvtsi32_si128(by as i32),
                _mm_cvtsi32_si128(64 - by as i32),
            );
            let (low, next) = (_mm256_srl_epi64(low, down), _mm256_sll_epi64(high, up));
            Avx2([_mm256_or_si256(low, next), _mm256_srl_epi64(high, down)])
        }
    }

    #[inline(always)]
    fn filled(self) -> Self {
        unsafe {
            let halves = _mm256_or_si256(self.0[0], self.0[1]);
            let without = _mm256_cmpeq_epi64(halves, _mm256_setzero_si256());
            Avx2([_mm256_xor_si256(without, _mm256_set1_epi64x(-1)); 2])
        }
    }

    #[inline(always)]
    fn sorted(self) -> Self {
        unsafe {
            // Then the parts of each block side by side.
            let bytes = _mm_loadu_si128(BY_BLOCKS.as_ptr().cast());
            let bytes = _mm256_broadcastsi128_si256(bytes);
            let order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
            let [low, high] = self.0;
            Avx2([
                _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(low, bytes), order),
                _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(high, bytes), order),
            ])
        }
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        unsafe {
            let all = _mm256_or_si256(self.0[0], self.0[1]);
            _mm256_testz_si256(all, all) == 1
        }
    }
}
