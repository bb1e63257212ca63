//! Rows of 512 bits in the registers of an instruction set.

use super::bits::{Bits, Row};

/// A row of bits under way.
///
/// The methods must be inlined into functions that are compiled for the
/// instruction set, and be called only where the processor has it.
pub(crate) trait BitRow: Bits {
    /// A row without bits.
    fn empty() -> Self;
    /// The row that starts at a byte.
    fn read(bytes: &[u8; 64]) -> Self;
    fn from_row(row: &Row) -> Self;
    fn to_row(self) -> Row;
    /// Writes the row to the first 64 bytes.
    #[inline(always)]
    fn write(self, bytes: &mut [u8]) {
        for (bytes, word) in bytes[..64].chunks_exact_mut(8).zip(self.to_row()) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
    }
    fn or(self, other: Self) -> Self;
    /// The bits of `self` that `other` lacks.
    fn without(self, other: Self) -> Self;
    /// Sum and carry of three bits.
    fn full_adder(self, b: Self, c: Self) -> (Self, Self);
    /// Every bit `by` places down, 0 to 63.
    fn shift_down(self, by: u32) -> Self;
}

/// Rows of several blocks, side by side: what is done with one is done with all.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Several<R, const N: usize>(pub [R; N]);

impl<R: BitRow, const N: usize> Several<R, N> {
    #[inline(always)]
    pub(crate) fn empty() -> Self {
        Several([R::empty(); N])
    }

    #[inline(always)]
    pub(crate) fn or(mut self, other: Self) -> Self {
        for i in 0..N {
            self.0[i] = self.0[i].or(other.0[i]);
        }
        self
    }

    #[inline(always)]
    pub(crate) fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        let (mut sum, mut carry) = (self, self);
        for i in 0..N {
            (sum.0[i], carry.0[i]) = self.0[i].full_adder(b.0[i], c.0[i]);
        }
        (sum, carry)
    }

    #[inline(always)]
    pub(crate) fn shift_down(mut self, by: u32) -> Self {
        for row in &mut self.0 {
            *row = row.shift_down(by);
        }
        self
    }
}

impl Bits for Row {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] & other[i])
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        self.iter().fold(0, |all, word| all | word) == 0
    }
}

impl BitRow for Row {
    #[inline(always)]
    fn empty() -> Self {
        [0; 8]
    }

    #[inline(always)]
    fn read(bytes: &[u8; 64]) -> Self {
        std::array::from_fn(|i| {
            let word: [u8; 8] = std::array::from_fn(|j| bytes[8 * i + j]);
            u64::from_le_bytes(word)
        })
    }

    #[inline(always)]
    fn from_row(row: &Row) -> Self {
        *row
    }

    #[inline(always)]
    fn to_row(self) -> Row {
        self
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] | other[i])
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] & !other[i])
    }

    #[inline(always)]
    fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        let sum = std::array::from_fn(|i| self[i] ^ b[i] ^ c[i]);
        let carry = std::array::from_fn(|i| (self[i] & b[i]) | (c[i] & (self[i] | b[i])));
        (sum, carry)
    }

    #[inline(always)]
    fn shift_down(self, by: u32) -> Self {
        std::array::from_fn(|i| {
            let next = if i < 7 && by > 0 {
                self[i + 1] << (64 - by)
            } else {
                0
            };
            self[i] >> by | next
        })
    }
}

#[cfg(target_arch = "x86_64")]
#[expect(
    clippy::undocumented_unsafe_blocks,
    reason = "one argument holds for all: rows of an instruction set are made only where the \
              processor has it, and all that is read or written is a whole row of 64 bytes"
)]
mod x86 {
    use std::arch::x86_64::*;

    use super::super::bits::Row;
    use super::{BitRow, Bits};

    /// What AVX-512 holds in one register.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx512(__m512i);

    impl Bits for Avx512 {
        #[inline(always)]
        fn and(self, other: Self) -> Self {
            unsafe { Avx512(_mm512_and_si512(self.0, other.0)) }
        }

        #[inline(always)]
        fn is_empty(self) -> bool {
            unsafe { _mm512_test_epi64_mask(self.0, self.0) == 0 }
        }
    }

    impl BitRow for Avx512 {
        #[inline(always)]
        fn empty() -> Self {
            unsafe { Avx512(_mm512_setzero_si512()) }
        }

        #[inline(always)]
        fn read(bytes: &[u8; 64]) -> Self {
            unsafe { Avx512(_mm512_loadu_si512(bytes.as_ptr().cast())) }
        }

        #[inline(always)]
        fn from_row(row: &Row) -> Self {
            unsafe { Avx512(_mm512_loadu_si512(row.as_ptr().cast())) }
        }

        #[inline(always)]
        fn to_row(self) -> Row {
            let mut row = [0; 8];
            unsafe { _mm512_storeu_si512(row.as_mut_ptr().cast(), self.0) };
            row
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
                let next = _mm512_alignr_epi64::<1>(_mm512_setzero_si512(), self.0);
                let low = _mm512_srl_epi64(self.0, _mm_cvtsi32_si128(by as i32));
                let high = _mm512_sll_epi64(next, _mm_cvtsi32_si128(64 - by as i32));
                Avx512(_mm512_or_si512(low, high))
            }
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

    impl Bits for Avx2 {
        #[inline(always)]
        fn and(self, other: Self) -> Self {
            self.zip(other, |a, b| unsafe { _mm256_and_si256(a, b) })
        }

        #[inline(always)]
        fn is_empty(self) -> bool {
            unsafe {
                let all = _mm256_or_si256(self.0[0], self.0[1]);
                _mm256_testz_si256(all, all) == 1
            }
        }
    }

    impl BitRow for Avx2 {
        #[inline(always)]
        fn empty() -> Self {
            unsafe { Avx2([_mm256_setzero_si256(); 2]) }
        }

        #[inline(always)]
        fn read(bytes: &[u8; 64]) -> Self {
            unsafe {
                Avx2([
                    _mm256_loadu_si256(bytes.as_ptr().cast()),
                    _mm256_loadu_si256(bytes.as_ptr().add(32).cast()),
                ])
            }
        }

        #[inline(always)]
        fn from_row(row: &Row) -> Self {
            unsafe {
                Avx2([
                    _mm256_loadu_si256(row.as_ptr().cast()),
                    _mm256_loadu_si256(row.as_ptr().add(4).cast()),
                ])
            }
        }

        #[inline(always)]
        fn to_row(self) -> Row {
            let mut row = [0u64; 8];
            unsafe {
                _mm256_storeu_si256(row.as_mut_ptr().cast(), self.0[0]);
                _mm256_storeu_si256(row.as_mut_ptr().add(4).cast(), self.0[1]);
            }
            row
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
                // The next word of each word: the lowest of `high` follows the
                // highest of `low`, and nothing follows that of `high`.
                let rotated = |a| _mm256_permute4x64_epi64::<0b00_11_10_01>(a);
                let (low_next, high_next) = (rotated(low), rotated(high));
                let low_next = _mm256_blend_epi32::<0b1100_0000>(low_next, high_next);
                let high_next =
                    _mm256_blend_epi32::<0b1100_0000>(high_next, _mm256_setzero_si256());
                let (down, up) = (
                    _mm_cvtsi32_si128(by as i32),
                    _mm_cvtsi32_si128(64 - by as i32),
                );
                let shift = |a, next| {
                    _mm256_or_si256(_mm256_srl_epi64(a, down), _mm256_sll_epi64(next, up))
                };
                Avx2([shift(low, low_next), shift(high, high_next)])
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512};
