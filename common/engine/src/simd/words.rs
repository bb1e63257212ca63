//! Words of bits, one for each of four neighbouring blocks: sums of votes bit by bit.
//!
//! All operations are plain: the compiler vectorizes them for the instruction set of the kernel.

use std::ops::{BitAnd, BitOr, Not};

/// Number of blocks whose bits are interleaved.
pub(crate) const QUAD: usize = 4;

/// Bytes of the words of a quad.
pub(crate) const BYTES: usize = 16 * QUAD;

/// A word of 128 bits for each block of a quad: the lower halves, then the upper ones. They fill a
/// cache line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(align(64))]
pub(crate) struct Words(pub [[u64; QUAD]; 2]);

impl Words {
    /// Words without bits.
    pub(crate) const EMPTY: Self = Words([[0; QUAD]; 2]);

    /// Returns words from the 128 bits of each block.
    #[inline(always)]
    pub(crate) fn of(block: impl Fn(usize) -> u128) -> Self {
        let words: [u128; QUAD] = std::array::from_fn(block);
        Words([
            words.map(|word| word as u64),
            words.map(|word| (word >> 64) as u64),
        ])
    }

    /// Returns the 128 bits of a block.
    #[inline(always)]
    pub(crate) fn block(&self, block: usize) -> u128 {
        u128::from(self.0[0][block]) | u128::from(self.0[1][block]) << 64
    }

    /// Reads bytes in the order of sets, see [`Set::sorted`](super::Set::sorted).
    #[inline(always)]
    pub(crate) fn read(bytes: &[u8; BYTES]) -> Self {
        Words(bytemuck::pod_read_unaligned(bytes))
    }

    /// Writes bytes as they were read.
    #[inline(always)]
    pub(crate) fn write(self, bytes: &mut [u8; BYTES]) {
        *bytes = bytemuck::cast(self.0);
    }

    /// Returns sum and carry of three bits.
    #[inline(always)]
    pub(crate) fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        let odd = self.zip(b, |a, b| a ^ b);
        (odd.zip(c, |odd, c| odd ^ c), self & b | odd & c)
    }

    /// Shifts every word down by 0 to 63 bits.
    #[inline(always)]
    pub(crate) fn shift_down(self, by: u32) -> Self {
        let Words([low, high]) = self;
        // Twice, as nothing may be shifted by 64.
        let low = std::array::from_fn(|i| low[i] >> by | high[i] << 1 << (63 - by));
        Words([low, high.map(|word| word >> by)])
    }

    /// Sets all bits of the words that have any.
    #[inline(always)]
    pub(crate) fn filled(self) -> Self {
        let Words([low, high]) = self;
        let filled = std::array::from_fn(|i| if low[i] | high[i] == 0 { 0 } else { u64::MAX });
        Words([filled; 2])
    }

    #[inline(always)]
    pub(crate) fn is_empty(self) -> bool {
        self.0.as_flattened().iter().fold(0, |all, word| all | word) == 0
    }

    #[inline(always)]
    fn zip(self, Words(other): Self, op: impl Fn(u64, u64) -> u64) -> Self {
        Words(std::array::from_fn(|half| {
            std::array::from_fn(|i| op(self.0[half][i], other[half][i]))
        }))
    }
}

impl BitAnd for Words {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }
}

impl BitOr for Words {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }
}

impl Not for Words {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Words(self.0.map(|half| half.map(|word| !word)))
    }
}
