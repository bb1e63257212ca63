//! A grid as rows of bits, laid out for sweeps along either axis.

use crate::directions::swap_unless;
use crate::grid::{Cell, Grid};

/// Bits of a word.
const WORD: usize = u64::BITS as usize;

/// One bit for each cell, row by row over the major axis. Rows are filled up to whole words
/// with cells that neither hold a ray nor send one back.
#[derive(Debug, Clone)]
pub(crate) struct BitGrid {
    /// Cells along the major axis.
    pub rows: usize,
    /// Cells along the minor axis.
    pub columns: usize,
    /// Words of a row.
    words: usize,
    occupied: Vec<u64>,
    /// Empty if no cell is blocked.
    blocked: Vec<u64>,
}

impl BitGrid {
    /// Lays out rows along y if `x_major`, else along x.
    pub(crate) fn new(grid: &Grid, x_major: bool) -> Self {
        let (rows, columns) = swap_unless(x_major, (grid.width(), grid.height()));
        let mut bits = BitGrid {
            rows,
            columns,
            words: columns.div_ceil(WORD),
            occupied: Vec::new(),
            blocked: Vec::new(),
        };
        bits.occupied = bits.collect(grid, x_major, Cell::Occupied);
        bits.blocked = bits.collect(grid, x_major, Cell::Blocked);
        if bits.blocked.iter().all(|&word| word == 0) {
            bits.blocked = Vec::new();
        }
        bits
    }

    fn collect(&self, grid: &Grid, x_major: bool, kind: Cell) -> Vec<u64> {
        let mut bits = vec![0; self.rows * self.words];
        for cell in grid.places(|cell| cell == kind) {
            let (row, column) = swap_unless(x_major, cell);
            bits[row * self.words + column / WORD] |= 1 << (column % WORD);
        }
        bits
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        8 * (self.occupied.len() + self.blocked.len())
    }

    /// True if any cell blocks rays without a hit.
    pub(crate) fn has_blocked(&self) -> bool {
        !self.blocked.is_empty()
    }

    /// Returns the occupied and the blocked cells of a row; the latter have no words if the
    /// grid has none.
    pub(crate) fn row(&self, row: usize) -> (&[u64], &[u64]) {
        let words = row * self.words..(row + 1) * self.words;
        let blocked = if self.has_blocked() {
            words.clone()
        } else {
            0..0
        };
        (&self.occupied[words], &self.blocked[blocked])
    }

    /// Returns the open cells of a row from a multiple of 64 on, the first in the lowest bit.
    #[inline(always)]
    pub(crate) fn open_word(&self, row: usize, column: usize) -> u64 {
        let word = row * self.words + column / WORD;
        let blocked = self.blocked.get(word).map_or(0, |&blocked| blocked);
        !(self.occupied[word] | blocked)
    }
}
