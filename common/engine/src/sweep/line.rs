//! Vectors of sums of neighbouring cells, and squares of them transposed.
//!
//! Written with the instructions that every x86-64 processor has: from plain
//! loops the compiler makes code that takes five times as long.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

#[cfg(target_arch = "x86_64")]
use bytemuck::must_cast;

#[cfg(target_arch = "x86_64")]
use crate::simd::sse2;

/// Sums of `N` neighbouring cells, as many as there are in a vector.
pub(super) trait Line<const N: usize>: Copy {
    /// Type of one sum.
    type Sum: Copy + Default;

    fn load(sums: &[Self::Sum; N]) -> Self;

    fn sums(self) -> [Self::Sum; N];

    /// Transposes a square.
    fn turned(rows: [Self; N]) -> [Self; N];

    /// Adds both in the cells whose bit is set, 0 elsewhere; the results must fit a sum.
    fn plus(self, other: Self, open: u16) -> [u16; N];
}

/// Eight sums of 16 bits.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Words(__m128i);

/// Sixteen sums of a byte.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
pub(super) struct Bytes(__m128i);

#[cfg(target_arch = "x86_64")]
sse2! {
    impl Line<8> for Words {
        type Sum = u16;

        fn load(sums: &[u16; 8]) -> Words {
            Words(must_cast(*sums))
        }

        fn sums(self) -> [u16; 8] {
            must_cast(self.0)
        }

        fn turned(rows: [Words; 8]) -> [Words; 8] {
            let mut rows = rows;
            // Three rounds that interleave rows i and i + 4 transpose a square.
            for _ in 0..3 {
                let before = rows;
                for i in 0..4 {
                    let (a, b) = (before[i].0, before[i + 4].0);
                    rows[2 * i] = Words(_mm_unpacklo_epi16(a, b));
                    rows[2 * i + 1] = Words(_mm_unpackhi_epi16(a, b));
                }
            }
            rows
        }

        fn plus(self, other: Words, open: u16) -> [u16; 8] {
            let open = must_cast(OPEN_WORDS[usize::from(open & 0xff)]);
            must_cast(_mm_and_si128(_mm_add_epi16(self.0, other.0), open))
        }
    }
}

#[cfg(target_arch = "x86_64")]
sse2! {
    impl Line<16> for Bytes {
        type Sum = u8;

        fn load(sums: &[u8; 16]) -> Bytes {
            Bytes(must_cast(*sums))
        }

        fn sums(self) -> [u8; 16] {
            must_cast(self.0)
        }

        fn turned(rows: [Bytes; 16]) -> [Bytes; 16] {
            let mut rows = rows;
            // The same as for words, in four rounds.
            for _ in 0..4 {
                let before = rows;
                for i in 0..8 {
                    let (a, b) = (before[i].0, before[i + 8].0);
                    rows[2 * i] = Bytes(_mm_unpacklo_epi8(a, b));
                    rows[2 * i + 1] = Bytes(_mm_unpackhi_epi8(a, b));
                }
            }
            rows
        }

        fn plus(self, other: Bytes, open: u16) -> [u16; 16] {
            let [low, high] = open.to_le_bytes().map(|bits| OPEN_BYTES[usize::from(bits)]);
            let sums = _mm_and_si128(_mm_add_epi8(self.0, other.0), _mm_set_epi64x(high, low));
            let zero = _mm_setzero_si128();
            must_cast([_mm_unpacklo_epi8(sums, zero), _mm_unpackhi_epi8(sums, zero)])
        }
    }
}

/// All ones in the words whose bit is set.
#[cfg(target_arch = "x86_64")]
static OPEN_WORDS: [[u16; 8]; 256] = {
    let mut masks = [[0; 8]; 256];
    let mut i = 0;
    while i < 8 * 256 {
        if (i / 8) >> (i % 8) & 1 == 1 {
            masks[i / 8][i % 8] = u16::MAX;
        }
        i += 1;
    }
    masks
};

/// All ones in the bytes whose bit is set.
#[cfg(target_arch = "x86_64")]
static OPEN_BYTES: [i64; 256] = {
    let mut masks = [0; 256];
    let mut i = 0;
    while i < 8 * 256 {
        if (i / 8) >> (i % 8) & 1 == 1 {
            masks[i / 8] |= 0xff << (8 * (i % 8));
        }
        i += 1;
    }
    masks
};

#[cfg(not(target_arch = "x86_64"))]
pub(super) use plain::{Bytes, Words};

/// For other processors, and as a reference.
#[cfg(any(test, not(target_arch = "x86_64")))]
mod plain {
    use std::array;

    use super::Line;

    pub(in crate::sweep) type Words = Plain<u16, 8>;
    pub(in crate::sweep) type Bytes = Plain<u8, 16>;

    /// Sums in an array.
    #[derive(Clone, Copy)]
    pub(in crate::sweep) struct Plain<S, const N: usize>([S; N]);

    impl<S: Copy + Default + Into<u16>, const N: usize> Line<N> for Plain<S, N> {
        type Sum = S;

        #[inline(always)]
        fn load(sums: &[S; N]) -> Self {
            Plain(*sums)
        }

        #[inline(always)]
        fn sums(self) -> [S; N] {
            self.0
        }

        #[inline(always)]
        fn turned(rows: [Self; N]) -> [Self; N] {
            array::from_fn(|i| Plain(array::from_fn(|j| rows[j].0[i])))
        }

        #[inline(always)]
        fn plus(self, other: Self, open: u16) -> [u16; N] {
            let sum = |i: usize| self.0[i].into() + other.0[i].into();
            array::from_fn(|i| if open >> i & 1 == 1 { sum(i) } else { 0 })
        }
    }
}

#[cfg(test)]
mod tests {
    use std::array;

    use super::{Bytes, Line, Words, plain};

    /// A square and its turned one added up row by row, some cells left out.
    fn sums<L: Line<N>, const N: usize>(numbers: &[L::Sum]) -> [[u16; N]; N] {
        let (rows, rest) = numbers.as_chunks();
        assert!(rows.len() == N && rest.is_empty());
        let rows: [L; N] = array::from_fn(|i| L::load(&rows[i]));
        let turned = L::turned(rows);
        array::from_fn(|i| rows[i].plus(turned[i], 0xb5d3_u16.rotate_left(i as u32)))
    }

    #[test]
    fn squares_are_turned_over_and_added_up() {
        let bytes: [u8; 256] = array::from_fn(|i| (i * 37 % 128) as u8);
        let found = sums::<Bytes, 16>(&bytes);
        assert_eq!(found, sums::<plain::Bytes, 16>(&bytes));
        let words: [u16; 64] = array::from_fn(|i| (i * 997 % 32768) as u16);
        assert_eq!(sums::<Words, 8>(&words), sums::<plain::Words, 8>(&words));
        // Bit 1 of the first row's mask is set, bit 2 is not.
        assert_eq!(found[0][1], u16::from(bytes[1]) + u16::from(bytes[16]));
        assert_eq!(found[0][2], 0);
    }
}
