//! Adds up the sums along both axes of a sweep: those along x lie on their side.

use super::bits::BitGrid;
use super::line::Line;

/// Sides of a block that is merged before the next, cells: its lines of both
/// sums and of the field stay in the nearest cache, and a word holds a line of bits.
const BLOCK: usize = 64;

/// Sides of the largest square that is turned over: rows of sums come in multiples.
pub(super) const SQUARE: usize = 16;

/// The sums of votes along one axis: row by row, from each row to the next so many.
pub(super) struct Plane<'a, S> {
    pub sums: &'a [S],
    pub stride: usize,
}

impl<S> Plane<'_, S> {
    /// Whether squares that cover so many rows and columns can be read, and whole
    /// blocks of each row.
    fn cover(&self, rows: usize, columns: usize) -> bool {
        self.stride >= columns.next_multiple_of(BLOCK)
            && self.sums.len() >= rows.next_multiple_of(SQUARE) * self.stride
    }

    /// From this cell on.
    ///
    /// # Safety
    /// There must be one.
    #[inline(always)]
    unsafe fn at(&self, row: usize, column: usize) -> *const S {
        // SAFETY: promised by the caller.
        unsafe { self.sums.as_ptr().add(row * self.stride + column) }
    }
}

/// A block of sums, row by row.
#[repr(align(64))]
struct Block<S>([[S; BLOCK]; BLOCK]);

/// Fills in the field: what `rows` and, turned over, `columns` hold of a cell
/// that is open, and nothing elsewhere.
///
/// # Panics
/// If there are fewer sums than whole blocks take.
// Inlined into a sweep it would be spilled all over the stack.
#[inline(never)]
pub(super) fn merge<L: Line<N>, const N: usize>(
    bits: &BitGrid,
    rows: &Plane<'_, L::Sum>,
    columns: &Plane<'_, L::Sum>,
    field: &mut [u16],
) {
    const { assert!(SQUARE.is_multiple_of(N) && BLOCK.is_multiple_of(SQUARE)) };
    assert!(rows.cover(bits.rows, bits.columns) && columns.cover(bits.columns, bits.rows));
    let mut turned = Block([[L::Sum::default(); BLOCK]; BLOCK]);
    for bottom in (0..bits.rows).step_by(BLOCK) {
        let height = BLOCK.min(bits.rows - bottom);
        for left in (0..bits.columns).step_by(BLOCK) {
            let width = BLOCK.min(bits.columns - left);
            for x in (0..width).step_by(N) {
                for y in (0..height).step_by(N) {
                    // SAFETY: the square lies in the sums and in the block.
                    unsafe {
                        let square = columns.at(left + x, bottom + y);
                        turn::<L, N>(square, columns.stride, &mut turned, (x, y));
                    }
                }
            }
            for (i, turned) in turned.0[..height].iter().enumerate() {
                let y = bottom + i;
                let open = bits.open_word(y, left);
                let to = &mut field[y * bits.columns + left..][..width];
                // SAFETY: rows of sums come in whole blocks.
                let row = unsafe { &*rows.at(y, left).cast::<[L::Sum; BLOCK]>() };
                match to.first_chunk_mut::<BLOCK>() {
                    Some(to) => add_up::<L, N>(row, turned, open, to),
                    None => {
                        let mut sums = [0; BLOCK];
                        add_up::<L, N>(row, turned, open, &mut sums);
                        to.copy_from_slice(&sums[..width]);
                    }
                }
            }
        }
    }
}

/// Turns a square over into its place in a block, at these columns and rows.
///
/// # Safety
/// There must be `N` rows of `N` sums, from each row to the next `stride` of them, and
/// the square must lie in the block.
#[inline(always)]
unsafe fn turn<L: Line<N>, const N: usize>(
    square: *const L::Sum,
    stride: usize,
    block: &mut Block<L::Sum>,
    (x, y): (usize, usize),
) {
    // SAFETY: promised by the caller.
    unsafe {
        let rows = std::array::from_fn(|i| L::load(square.add(i * stride)));
        let to = block.0.as_mut_ptr().cast::<L::Sum>().add(BLOCK * y + x);
        for (i, row) in L::turned(rows).into_iter().enumerate() {
            row.store(to.add(BLOCK * i));
        }
    }
}

/// Adds up two lines where a bit of the word is set.
#[inline(always)]
fn add_up<L: Line<N>, const N: usize>(
    row: &[L::Sum; BLOCK],
    turned: &[L::Sum; BLOCK],
    open: u64,
    to: &mut [u16; BLOCK],
) {
    let (row, turned) = (row.as_ptr(), turned.as_ptr());
    for (i, to) in to.as_chunks_mut::<N>().0.iter_mut().enumerate() {
        // SAFETY: both have as many as are added up.
        let (row, turned) = unsafe { (L::load(row.add(N * i)), L::load(turned.add(N * i))) };
        *to = row.plus(turned, (open >> (N * i)) as u16);
    }
}
