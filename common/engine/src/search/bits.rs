//! Rows of bits and numbers kept as planes, side by side for 512 headings.
//!
//! Plane `j` of numbers holds bit `j` of all of them.

use super::rows::BitRow;

/// Bits that are taken together: a row of them, or a window of one.
pub(crate) trait Bits: Copy {
    fn and(self, other: Self) -> Self;
    fn is_empty(self) -> bool;
}

impl Bits for u64 {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }

    #[inline(always)]
    fn is_empty(self) -> bool {
        self == 0
    }
}

/// 512 bits, one for each heading of a chunk.
pub(crate) type Row = [u64; 8];

/// A row without bits.
pub(crate) const EMPTY: Row = [0; 8];

/// Planes of numbers: they fit 16 bits.
pub(crate) const PLANES: usize = 16;

/// 512 numbers, by plane.
pub(crate) type Planes = [Row; PLANES];

/// The greatest of the numbers that `among` selects, of so many planes.
#[inline(always)]
pub(crate) fn greatest<B: Bits>(planes: usize, number: impl Fn(usize) -> B, among: B) -> u16 {
    let (mut candidates, mut value) = (among, 0);
    for plane in (0..planes).rev() {
        let higher = candidates.and(number(plane));
        if !higher.is_empty() {
            candidates = higher;
            value |= 1 << plane;
        }
    }
    value
}

/// Where the numbers that `among` selects, of so many planes, are at least `least`.
#[inline(always)]
pub(crate) fn at_least<R: BitRow>(
    planes: usize,
    number: impl Fn(usize) -> R,
    least: u16,
    among: R,
) -> R {
    if usize::from(least) >> planes != 0 {
        return R::empty();
    }
    // Equal so far from the highest plane down, or greater already.
    let (mut equal, mut greater) = (among, R::empty());
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

/// The places of the set bits of a word, ascending.
pub(crate) fn ones(word: u64) -> impl Iterator<Item = usize> {
    let mut word = word;
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros() as usize;
        (word != 0).then(|| {
            word &= word - 1;
            bit
        })
    })
}

/// Takes the first set bit of a row and those less than 64 places behind it:
/// the place of the first, and all of them from there.
pub(crate) fn take_window(row: &mut Row) -> Option<(usize, u64)> {
    let word = row.iter().position(|&word| word != 0)?;
    let shift = row[word].trailing_zeros();
    let mut window = row[word] >> shift;
    row[word] = 0;
    if shift > 0
        && let Some(next) = row.get_mut(word + 1)
    {
        window |= *next << (64 - shift);
        *next = *next >> shift << shift;
    }
    Some((64 * word + shift as usize, window))
}

/// The bits of a row from a place on, as many as a window has, see [`take_window`]; none
/// behind the row's end.
#[inline(always)]
pub(crate) fn window_of(row: &Row, first: usize) -> u64 {
    let (word, shift) = (first / 64, first % 64);
    let next = row.get(word + 1).copied().unwrap_or(0);
    // Twice, as nothing may be shifted by 64.
    row[word] >> shift | next << 1 << (63 - shift)
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn planes_are_compared_like_plain_numbers(
            plain in vec(any::<u16>(), 512), among in any::<[u64; 8]>(), least in any::<u16>(),
        ) {
            let mut planes = [EMPTY; PLANES];
            for (i, &number) in plain.iter().enumerate() {
                for (plane, bits) in planes.iter_mut().enumerate() {
                    bits[i / 64] |= u64::from(number >> plane & 1) << (i % 64);
                }
            }
            let selected = |i: &usize| among[i / 64] >> (i % 64) & 1 == 1;
            let most = (0..512).filter(selected).map(|i| plain[i]).max();
            prop_assert_eq!(greatest(PLANES, |plane| planes[plane], among), most.unwrap_or(0));
            let found = at_least(PLANES, |plane| planes[plane], least, among);
            for i in 0..512 {
                prop_assert_eq!(found[i / 64] >> (i % 64) & 1 == 1, selected(&i) && plain[i] >= least);
            }
        }

        #[test]
        fn windows_hold_each_bit_once(
            row in any::<[u64; 8]>(), sparse in any::<[u64; 8]>(), numbers in any::<[Row; 5]>(),
        ) {
            let row: Row = std::array::from_fn(|i| row[i] & sparse[i]);
            let (mut rest, mut found) = (row, EMPTY);
            let mut before = rest;
            while let Some((first, window)) = take_window(&mut rest) {
                prop_assert_eq!(window & 1, 1);
                let taken: Row = std::array::from_fn(|i| before[i] & !rest[i]);
                prop_assert_eq!(window_of(&taken, first), window);
                let greatest_in = greatest(numbers.len(), |plane| window_of(&numbers[plane], first), window);
                prop_assert_eq!(greatest_in, greatest(numbers.len(), |plane| numbers[plane], taken));
                before = rest;
                for i in ones(window).map(|i| first + i) {
                    prop_assert_eq!(found[i / 64] >> (i % 64) & 1, 0);
                    found[i / 64] |= 1 << (i % 64);
                }
            }
            prop_assert_eq!(found, row);
            prop_assert_eq!(row.is_empty(), row == EMPTY);
        }
    }
}
