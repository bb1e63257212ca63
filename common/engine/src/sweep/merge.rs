//! Adds up the sums along both axes of a sweep: those along x lie on their side.

use std::array;

use super::bits::BitGrid;
use super::kernel::Sum;
use super::octet::Octet;

/// Sides of a block that is merged before the next, cells: its lines of both
/// sums and of the field stay in the nearest cache.
const BLOCK: usize = 64;

/// Sides of a square that is turned over.
const SQUARE: usize = 8;

/// The sums of votes along one axis: row by row, from each row to the next so many.
pub(super) struct Plane<'a, S> {
    pub sums: &'a [S],
    pub stride: usize,
}

impl<S> Plane<'_, S> {
    /// Whether squares that cover so many rows and columns can be read.
    fn cover(&self, rows: usize, columns: usize) -> bool {
        self.stride >= columns.next_multiple_of(SQUARE)
            && self.sums.len() >= rows.next_multiple_of(SQUARE) * self.stride
    }
}

/// Fills in the field: what `rows` and, turned over, `columns` hold of a cell
/// that is open, and nothing elsewhere.
///
/// # Panics
/// If there are fewer sums than whole squares take.
// Inlined into a sweep it would be spilled all over the stack.
#[inline(never)]
pub(super) fn merge<S: Sum>(
    bits: &BitGrid,
    rows: &Plane<'_, S>,
    columns: &Plane<'_, S>,
    field: &mut [u16],
) {
    assert!(rows.cover(bits.rows, bits.columns) && columns.cover(bits.columns, bits.rows));
    for bottom in (0..bits.rows).step_by(BLOCK) {
        for left in (0..bits.columns).step_by(BLOCK) {
            for y in (bottom..(bottom + BLOCK).min(bits.rows)).step_by(SQUARE) {
                for x in (left..(left + BLOCK).min(bits.columns)).step_by(SQUARE) {
                    // SAFETY: the square lies in both sums.
                    unsafe { square(bits, rows, columns, (x, y), field) }
                }
            }
        }
    }
}

/// # Safety
/// Both sums must hold the square.
#[inline(always)]
unsafe fn square<S: Sum>(
    bits: &BitGrid,
    rows: &Plane<'_, S>,
    columns: &Plane<'_, S>,
    (left, bottom): (usize, usize),
    field: &mut [u16],
) {
    // SAFETY: promised by the caller.
    let (row, turned) = unsafe {
        let row = rows.sums.as_ptr().add(bottom * rows.stride + left);
        let column = columns.sums.as_ptr().add(left * columns.stride + bottom);
        let column = |x| S::octet(column.add(x * columns.stride));
        (row, Octet::turned(array::from_fn(column)))
    };
    for (i, (y, turned)) in (bottom..bits.rows).zip(turned).enumerate() {
        // SAFETY: as above.
        let row = unsafe { S::octet(row.add(i * rows.stride)) };
        let sums = row.plus(turned, &OPEN[usize::from(bits.open_octet(y, left))]);
        let to = &mut field[y * bits.columns..][..bits.columns][left..];
        match to.first_chunk_mut() {
            Some(octet) => *octet = sums,
            None => to.copy_from_slice(&sums[..to.len()]),
        }
    }
}

/// All ones where a bit is set.
static OPEN: [[u16; 8]; 256] = {
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
