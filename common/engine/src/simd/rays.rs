//! Ends of eight adjacent rays.

use super::{CELLS, SIDE};
use crate::program::NO_RANGE;

/// Number of rows of a word, and of adjacent rays in each.
pub(crate) const ROWS: i64 = 8;

/// Largest number of rays in a bundle.
pub(crate) const RAYS: usize = ROWS as usize;

/// Order in which rays cross the cells of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Across {
    /// Number of columns that a ray has met before the cell.
    pub column: [u16; CELLS],
    /// Place of the cell in its column.
    pub minor: [u16; CELLS],
}

impl Across {
    /// Orders for rays along y and along x, each forward and backward.
    pub(crate) const ALL: [[Across; 2]; 2] = [
        [Across::new(false, false), Across::new(false, true)],
        [Across::new(true, false), Across::new(true, true)],
    ];

    const fn new(x_major: bool, backward: bool) -> Self {
        let (mut column, mut minor) = ([0; CELLS], [0; CELLS]);
        let mut cell = 0;
        while cell < CELLS {
            let (x, y) = ((cell % SIDE) as u16, (cell / SIDE) as u16);
            let (major, along) = if x_major { (x, y) } else { (y, x) };
            column[cell] = if backward {
                SIDE as u16 - 1 - major
            } else {
                major
            };
            minor[cell] = along;
            cell += 1;
        }
        Across { column, minor }
    }
}

/// Rows of bits on a slope.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BitRows<'a> {
    pub rows: &'a [u32; RAYS],
    /// First bit of the first row that is read, times 2³², and the increase for each further
    /// row. Eight bits are read in each row.
    pub bit: i64,
    pub slope: i64,
}

impl BitRows<'_> {
    /// Returns eight bits of each of eight rows, a byte for each row.
    #[inline(always)]
    pub(crate) fn word(&self) -> u64 {
        let bytes = std::array::from_fn(|row| {
            let bit = (self.bit + row as i64 * self.slope) >> 32;
            (self.rows[row] >> (bit & 31)) as u8
        });
        u64::from_le_bytes(bytes)
    }
}

/// Position at which each of adjacent rays ends first, or [`NO_RANGE`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hits(pub [u16; RAYS]);

impl Hits {
    /// Notes the rays that end at one of eight positions, unless they ended before. Bit `i` of
    /// byte `j` of the word is set if ray `i` ends at `position + j`. Returns a bit for each ray
    /// that ends in the word.
    #[inline(always)]
    pub(crate) fn note(&mut self, word: u64, position: i64) -> u8 {
        /// The bits of the first ray.
        const FIRST: u64 = 0x0101_0101_0101_0101;
        for (i, hit) in self.0.iter_mut().enumerate() {
            let ends = (word >> i) & FIRST;
            let at = position + i64::from(ends.trailing_zeros() / 8);
            let at = if ends == 0 { NO_RANGE } else { at as u16 };
            *hit = at.min(*hit);
        }
        let folded = word | word >> 32;
        let folded = folded | folded >> 16;
        (folded | folded >> 8) as u8
    }

    /// Returns the ranges of the cells of a block, given the ray of each column's first cell.
    #[inline(always)]
    pub(crate) fn ranges(&self, first: &[u16; SIDE], across: &Across) -> [u16; CELLS] {
        std::array::from_fn(|i| {
            let column = across.column[i];
            let hit = self.0[usize::from(first[usize::from(column)] + across.minor[i]) % RAYS];
            if hit == NO_RANGE { hit } else { hit - column }
        })
    }
}
