//! Words of bits, one for each of four neighbouring blocks: sums of votes bit by bit.

#[cfg(target_arch = "x86_64")]
mod x86;

use super::Portable;
#[cfg(target_arch = "x86_64")]
pub(crate) use x86::Avx2Words;

/// Number of blocks whose bits are interleaved.
pub(crate) const QUAD: usize = 4;

/// A word of 128 bits for each block of a quad: the lower halves, then the upper ones.
pub(crate) type Words = [[u64; QUAD]; 2];

/// Words without bits.
pub(crate) const EMPTY: Words = [[0; QUAD]; 2];

/// Bytes of the words of a quad.
pub(crate) const BYTES: usize = 16 * QUAD;

/// Words of a quad in registers, one for each block.
pub(crate) trait BitWords: Copy {
    /// The token of the instruction set.
    type Set: Copy;

    /// Returns words without bits.
    fn empty(set: Self::Set) -> Self;
    /// Returns the same word for each block.
    fn splat(set: Self::Set, word: u128) -> Self;
    /// Reads bytes in the order of sets, see [`BitWords::sorted`].
    fn read(set: Self::Set, bytes: &[u8; BYTES]) -> Self;
    /// Spreads groups of four bytes: places that the mask selects get the next group of
    /// `bytes`, others get no bits.
    fn expand(set: Self::Set, mask: u16, bytes: &[u8; BYTES]) -> Self;
    fn from_words(set: Self::Set, words: &Words) -> Self;
    fn to_words(self) -> Words;
    fn and(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self;
    /// Returns the bits of `self` that `other` lacks.
    fn without(self, other: Self) -> Self;
    /// Returns sum and carry of three bits.
    fn full_adder(self, b: Self, c: Self) -> (Self, Self);
    /// Shifts every word down by 0 to 63 bits.
    fn shift_down(self, by: u32) -> Self;
    /// Sets all bits of the words that have any.
    fn filled(self) -> Self;
    /// Returns words from bytes in the order of sets: the first of each block, the second of
    /// each, and so on.
    fn sorted(self) -> Self;
    fn is_empty(self) -> bool;

    /// Writes bytes as they were read.
    #[inline(always)]
    fn write(self, bytes: &mut [u8; BYTES]) {
        *bytes = bytemuck::cast(self.to_words());
    }
}

impl BitWords for Words {
    type Set = Portable;

    #[inline(always)]
    fn empty(_: Portable) -> Self {
        EMPTY
    }

    #[inline(always)]
    fn splat(_: Portable, word: u128) -> Self {
        [word as u64, (word >> 64) as u64].map(|half| [half; QUAD])
    }

    #[inline(always)]
    fn read(_: Portable, bytes: &[u8; BYTES]) -> Self {
        bytemuck::pod_read_unaligned(bytes)
    }

    #[inline(always)]
    fn expand(_: Portable, mask: u16, bytes: &[u8; BYTES]) -> Self {
        let from: &[[u8; QUAD]; BYTES / QUAD] = bytemuck::cast_ref(bytes);
        let mut fours = [[0; QUAD]; BYTES / QUAD];
        let mut next = 0;
        for (i, to) in fours.iter_mut().enumerate() {
            if mask >> i & 1 == 1 {
                *to = from[next];
                next += 1;
            }
        }
        bytemuck::cast(fours)
    }

    #[inline(always)]
    fn from_words(_: Portable, words: &Words) -> Self {
        *words
    }

    #[inline(always)]
    fn to_words(self) -> Words {
        self
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        zip(self, other, |a, b| a & b)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        zip(self, other, |a, b| a | b)
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        zip(self, other, |a, b| a & !b)
    }

    #[inline(always)]
    fn full_adder(self, b: Self, c: Self) -> (Self, Self) {
        let odd = zip(self, b, |a, b| a ^ b);
        let sum = zip(odd, c, |odd, c| odd ^ c);
        (sum, self.and(b).or(odd.and(c)))
    }

    #[inline(always)]
    fn shift_down(self, by: u32) -> Self {
        let [low, high] = self;
        // Twice, as nothing may be shifted by 64.
        let low = std::array::from_fn(|i| low[i] >> by | high[i] << 1 << (63 - by));
        [low, high.map(|word| word >> by)]
    }

    #[inline(always)]
    fn filled(self) -> Self {
        let [low, high] = self;
        let filled = std::array::from_fn(|i| if low[i] | high[i] == 0 { 0 } else { u64::MAX });
        [filled; 2]
    }

    #[inline(always)]
    fn sorted(self) -> Self {
        self.map(|half| {
            let bytes: [u8; BYTES / 2] = bytemuck::cast(half);
            std::array::from_fn(|block| {
                u64::from_le_bytes(std::array::from_fn(|i| bytes[QUAD * i + block]))
            })
        })
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        self.as_flattened().iter().fold(0, |all, word| all | word) == 0
    }
}

#[inline(always)]
fn zip(a: Words, b: Words, op: impl Fn(u64, u64) -> u64) -> Words {
    std::array::from_fn(|half| std::array::from_fn(|i| op(a[half][i], b[half][i])))
}
