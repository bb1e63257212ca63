//! A set of cells of a grid, one bit per cell.

/// Bits per word.
pub(crate) const WORD: usize = 64;

/// A set of cells of a grid, numbered row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CellSet {
    words: Vec<u64>,
}

impl CellSet {
    /// Collects the cells, of this many, for which `holds` returns true.
    pub(crate) fn of(cells: usize, holds: impl Fn(usize) -> bool) -> Self {
        let word = |first: usize| {
            let word = first..cells.min(first + WORD);
            word.fold(0, |word, i| word | u64::from(holds(i)) << (i - first))
        };
        CellSet {
            words: (0..cells).step_by(WORD).map(word).collect(),
        }
    }

    /// Collects the cells for whose byte `holds` returns true; many times faster than
    /// [`CellSet::of`].
    pub(crate) fn of_bytes(cells: &[u8], holds: impl Fn(u8) -> bool) -> Self {
        /// Multiplication by this gathers the lowest bits of eight bytes in the last byte.
        const GATHER: u64 = 0x0102_0408_1020_4080;
        let word = |cells: &[u8]| {
            let mut flags = [0; WORD];
            for (flag, &cell) in flags.iter_mut().zip(cells) {
                *flag = u8::from(holds(cell));
            }
            let (eights, _) = flags.as_chunks();
            let bits = eights
                .iter()
                .map(|&eight| u64::from_le_bytes(eight).wrapping_mul(GATHER) >> 56);
            bits.rev().fold(0, |word, bits| word << 8 | bits)
        };
        CellSet {
            words: cells.chunks(WORD).map(word).collect(),
        }
    }

    /// Creates an empty set for this many cells.
    pub(crate) fn none(cells: usize) -> Self {
        CellSet {
            words: vec![0; cells.div_ceil(WORD)],
        }
    }

    /// Removes the cells for which `holds` returns false.
    pub(crate) fn retain(&mut self, holds: impl Fn(usize) -> bool) {
        for (i, word) in self.words.iter_mut().enumerate() {
            let first = i * WORD;
            for bit in ones(*word) {
                *word &= !(u64::from(!holds(first + bit)) << bit);
            }
        }
    }

    pub(crate) fn insert(&mut self, cell: usize) {
        self.words[cell / WORD] |= 1 << (cell % WORD);
    }

    pub(crate) fn count(&self) -> usize {
        self.words
            .iter()
            .map(|word| word.count_ones() as usize)
            .sum()
    }

    /// Memory in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.words[..])
    }

    /// One bit per cell, lowest first.
    #[inline(always)]
    pub(crate) fn words(&self) -> &[u64] {
        &self.words
    }

    pub(crate) fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// True if all cells in the set are among the first `cells`.
    pub(crate) fn are_below(&self, cells: usize) -> bool {
        let (full, rest) = (cells / WORD, cells % WORD);
        let mut beyond = self.words.iter().skip(full);
        beyond.next().is_none_or(|word| word >> rest == 0) && beyond.all(|&word| word == 0)
    }

    #[inline(always)]
    pub(crate) fn holds(&self, cell: usize) -> bool {
        self.words[cell / WORD] >> (cell % WORD) & 1 == 1
    }

    /// Cells of the set, in ascending order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = usize> {
        let words = self.words.iter().enumerate();
        words.flat_map(|(i, &word)| ones(word).map(move |bit| i * WORD + bit))
    }

    /// Sets the votes of all other cells to 0.
    pub(crate) fn clear_others(&self, votes: &mut [u16]) {
        for (votes, &word) in votes.chunks_mut(WORD).zip(&self.words) {
            match word {
                0 => votes.fill(0),
                u64::MAX => {}
                _ => {
                    for (bit, votes) in votes.iter_mut().enumerate() {
                        *votes *= (word >> bit & 1) as u16;
                    }
                }
            }
        }
    }
}

/// Returns the places of the set bits of a word, in ascending order.
pub(crate) fn ones(mut word: u64) -> impl Iterator<Item = usize> + Clone {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros() as usize;
        (word != 0).then(|| {
            word &= word - 1;
            bit
        })
    })
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_set_holds_what_it_is_made_of(
            held in vec(prop::bool::weighted(0.8), 0..300), kept in vec(any::<bool>(), 300),
        ) {
            let mut set = CellSet::of(held.len(), |i| held[i]);
            prop_assert!((0..held.len()).all(|i| set.holds(i) == held[i]));
            let bytes: Vec<u8> = held.iter().map(|&held| if held { 7 } else { 200 }).collect();
            prop_assert_eq!(&CellSet::of_bytes(&bytes, |byte| byte < 100), &set);
            prop_assert_eq!(set.count(), held.iter().filter(|&&held| held).count());
            prop_assert!(set.are_below(held.len()));
            prop_assert_eq!(set.are_below(held.len() / 2), held[held.len() / 2..].iter().all(|&held| !held));
            set.retain(|i| kept[i]);
            let both: Vec<usize> = (0..held.len()).filter(|&i| held[i] && kept[i]).collect();
            prop_assert_eq!(set.iter().collect::<Vec<_>>(), both.clone());
            let mut votes = vec![7; held.len()];
            set.clear_others(&mut votes);
            prop_assert!((0..held.len()).all(|i| (votes[i] == 7) == both.contains(&i)));
        }

        #[test]
        fn all_cells_are_a_set_as_well(cells in 0usize..300) {
            let mut votes = vec![7; cells];
            CellSet::of(cells, |_| true).clear_others(&mut votes);
            prop_assert!(votes.iter().all(|&votes| votes == 7));
            CellSet::of(cells, |_| false).clear_others(&mut votes);
            prop_assert!(votes.iter().all(|&votes| votes == 0));
        }
    }
}
