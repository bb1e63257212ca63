//! Bits of adjacent headings, and numbers stored as planes of bits.
//!
//! Headings come in chunks with one word of bits each. Plane `j` holds bit `j` of all
//! numbers.

pub(crate) use crate::grid::ones;
use crate::simd::words::{BitWords, QUAD, Words};

/// Headings of a chunk: the 128 bits of a word, less those that shifting takes up.
pub(crate) const CHUNK: usize = 120;

/// Mask of the bits of a chunk.
const WHOLE: u128 = u128::MAX >> (128 - CHUNK);

/// Largest number of planes: numbers fit 16 bits.
pub(crate) const PLANES: usize = 16;

/// Returns the 128 bits of a block.
#[inline(always)]
pub(crate) fn of_block(words: &Words, block: usize) -> u128 {
    u128::from(words[0][block]) | u128::from(words[1][block]) << 64
}

/// Returns the words of a quad from the 128 bits of each block.
#[inline(always)]
pub(crate) fn words(of_block: impl Fn(usize) -> u128) -> Words {
    let words: [u128; QUAD] = std::array::from_fn(of_block);
    [
        words.map(|word| word as u64),
        words.map(|word| (word >> 64) as u64),
    ]
}

/// Returns the greatest of the numbers of each block, of this many planes, that `among`
/// selects.
#[inline(always)]
pub(crate) fn greatest_of_each<W: BitWords>(
    set: W::Set,
    planes: usize,
    number: impl Fn(usize) -> W,
    among: W,
) -> [u16; QUAD] {
    let (mut candidates, mut value) = (among, W::empty(set));
    for plane in (0..planes).rev() {
        let higher = candidates.and(number(plane));
        let any = higher.filled();
        candidates = higher.or(candidates.without(any));
        value = value.or(any.and(W::splat(set, 1 << plane)));
    }
    value.to_words()[0].map(|value| value as u16)
}

/// Returns a bit for each number, of this many planes, that `among` selects and that is at
/// least `least`.
#[inline(always)]
pub(crate) fn at_least<W: BitWords>(
    set: W::Set,
    planes: usize,
    number: impl Fn(usize) -> W,
    least: u16,
    among: W,
) -> W {
    if least == 0 {
        return among;
    }
    if usize::from(least) >> planes != 0 {
        return W::empty(set);
    }
    // Equal so far from the highest plane down, or greater already.
    let (mut equal, mut greater) = (among, W::empty(set));
    for plane in (0..planes).rev() {
        let bits = number(plane);
        if least >> plane & 1 == 1 {
            equal = equal.and(bits);
        } else {
            greater = greater.or(equal.and(bits));
            equal = equal.without(bits);
        }
    }
    greater.or(equal)
}

/// Returns the set bits of this many chunks in windows: the place of a window's first bit,
/// and the bits of the 64 places from there on.
pub(crate) fn windows(
    chunks: usize,
    bits: impl Fn(usize) -> u128,
) -> impl Iterator<Item = (usize, u64)> {
    let mut next = 0;
    std::iter::from_fn(move || {
        while next < chunks * CHUNK {
            let window = window_of(chunks, &bits, next);
            if window != 0 {
                let first = next + window.trailing_zeros() as usize;
                next = first + u64::BITS as usize;
                return Some((first, window_of(chunks, &bits, first)));
            }
            next += u64::BITS as usize;
        }
        None
    })
}

/// Returns the 64 bits from place `first` on; they are 0 after the last chunk.
#[inline(always)]
pub(crate) fn window_of(chunks: usize, bits: impl Fn(usize) -> u128, first: usize) -> u64 {
    let (chunk, place) = (first / CHUNK, first % CHUNK);
    let mut window = 0;
    if chunk < chunks {
        window = ((bits(chunk) & WHOLE) >> place) as u64;
    }
    if let behind @ ..64 = CHUNK - place
        && chunk + 1 < chunks
    {
        window |= (bits(chunk + 1) << behind) as u64;
    }
    window
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::simd::Portable;
    use crate::simd::words::EMPTY;

    proptest! {
        #[test]
        fn planes_are_compared_like_plain_numbers(
            plain in vec(any::<u16>(), QUAD * 128), among in any::<Words>(), least in any::<u16>(),
        ) {
            let mut planes = [EMPTY; PLANES];
            for (i, &number) in plain.iter().enumerate() {
                for (plane, bits) in planes.iter_mut().enumerate() {
                    bits[i / 64 % 2][i / 128] |= u64::from(number >> plane & 1) << (i % 64);
                }
            }
            let found = at_least(Portable, PLANES, |plane| planes[plane], least, among);
            let greatest_of_each = greatest_of_each(Portable, PLANES, |plane| planes[plane], among);
            for block in 0..QUAD {
                let (among, found) = (of_block(&among, block), of_block(&found, block));
                let numbers = &plain[128 * block..][..128];
                let is_selected = |i: usize| among >> i & 1 == 1;
                let selected = |i: &usize| is_selected(*i);
                let most = (0..128).filter(selected).map(|i| numbers[i]).max();
                prop_assert_eq!(greatest_of_each[block], most.unwrap_or(0));
                for (i, &number) in numbers.iter().enumerate() {
                    prop_assert_eq!(found >> i & 1 == 1, is_selected(i) && number >= least);
                }
            }
            prop_assert_eq!(words(|block| of_block(&among, block)), among);
        }

        #[test]
        fn windows_hold_each_bit_once(all in vec(any::<u128>(), 0..6), sparse in vec(any::<u128>(), 6)) {
            let words: Vec<_> = all.iter().zip(&sparse).map(|(all, sparse)| all & sparse).collect();
            let set = |i: usize| words[i / CHUNK] >> (i % CHUNK) & 1 == 1;
            let plain: Vec<_> = (0..CHUNK * words.len()).filter(|&i| set(i)).collect();
            let mut found = Vec::new();
            for (first, window) in windows(words.len(), |chunk| words[chunk]) {
                prop_assert_eq!(window & 1, 1);
                prop_assert_eq!(window_of(words.len(), |chunk| words[chunk], first), window);
                found.extend(ones(window).map(|i| first + i));
            }
            prop_assert_eq!(found, plain);
        }
    }
}
