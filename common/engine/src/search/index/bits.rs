//! Bits of adjacent headings, and numbers stored as planes of bits.
//!
//! Headings come in chunks with one word of bits each. Plane `j` holds bit `j` of all
//! numbers.

pub(crate) use crate::grid::ones;
use crate::simd::words::{QUAD, Words};

/// Headings of a chunk: the 128 bits of a word, less those that shifting takes up.
pub(crate) const CHUNK: usize = 120;

/// Mask of the bits of a chunk.
const WHOLE: u128 = u128::MAX >> (128 - CHUNK);

/// Largest number of planes: numbers fit 16 bits.
pub(crate) const PLANES: usize = 16;

/// Returns the greatest of the numbers of each block that `among` selects.
#[inline(always)]
pub(crate) fn greatest_of_each(planes: &[Words], among: Words) -> [u16; QUAD] {
    let (mut candidates, mut value) = (among, Words::EMPTY);
    for (i, &plane) in planes.iter().enumerate().rev() {
        let higher = candidates & plane;
        let any = higher.filled();
        candidates = higher | candidates & !any;
        value = value | any & Words::of(|_| 1 << i);
    }
    value.0[0].map(|value| value as u16)
}

/// Returns a bit for each number that `among` selects and that is at least `least`.
#[inline(always)]
pub(crate) fn at_least(planes: &[Words], least: u16, among: Words) -> Words {
    if least == 0 {
        return among;
    }
    if usize::from(least) >> planes.len() != 0 {
        return Words::EMPTY;
    }
    // Equal so far from the highest plane down, or greater already.
    let (mut equal, mut greater) = (among, Words::EMPTY);
    for (i, &plane) in planes.iter().enumerate().rev() {
        if least >> i & 1 == 1 {
            equal = equal & plane;
        } else {
            greater = greater | equal & plane;
            equal = equal & !plane;
        }
    }
    greater | equal
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

    proptest! {
        #[test]
        fn planes_are_compared_like_plain_numbers(
            plain in vec(any::<u16>(), QUAD * 128), among in any::<[[u64; QUAD]; 2]>(), least in any::<u16>(),
        ) {
            let among = Words(among);
            let mut planes = [Words::EMPTY; PLANES];
            for (i, &number) in plain.iter().enumerate() {
                for (plane, bits) in planes.iter_mut().enumerate() {
                    bits.0[i / 64 % 2][i / 128] |= u64::from(number >> plane & 1) << (i % 64);
                }
            }
            let found = at_least(&planes, least, among);
            let greatest_of_each = greatest_of_each(&planes, among);
            for block in 0..QUAD {
                let (among, found) = (among.block(block), found.block(block));
                let numbers = &plain[128 * block..][..128];
                let is_selected = |i: usize| among >> i & 1 == 1;
                let selected = |i: &usize| is_selected(*i);
                let most = (0..128).filter(selected).map(|i| numbers[i]).max();
                prop_assert_eq!(greatest_of_each[block], most.unwrap_or(0));
                for (i, &number) in numbers.iter().enumerate() {
                    prop_assert_eq!(found >> i & 1 == 1, is_selected(i) && number >= least);
                }
            }
            prop_assert_eq!(Words::of(|block| among.block(block)), among);
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
