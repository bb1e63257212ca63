//! Adds up the sums along both axes of a sweep; those along x are transposed.

use super::bits::BitGrid;
use super::line::Line;

/// Side of a block that is merged before the next, in cells: its lines of both sums and of
/// the field stay in the nearest cache, and a word holds a line of bits.
const BLOCK: usize = 64;

/// Side of the largest square that is transposed: rows of sums come in multiples of it.
pub(super) const SQUARE: usize = 16;

/// Sums of votes along one axis, row by row, with `stride` sums from each row to the next.
pub(super) struct Plane<'a, S> {
    pub sums: &'a [S],
    pub stride: usize,
}

impl<S> Plane<'_, S> {
    /// True if squares that cover this many rows and columns can be read, and whole blocks of
    /// each row.
    fn cover(&self, rows: usize, columns: usize) -> bool {
        self.stride >= columns.next_multiple_of(BLOCK)
            && self.sums.len() >= rows.next_multiple_of(SQUARE) * self.stride
    }

    /// Returns `N` sums of a row from a column on.
    #[inline(always)]
    fn at<const N: usize>(&self, row: usize, column: usize) -> &[S; N] {
        const COVERED: &str = "sums cover the squares that are read";
        self.sums[row * self.stride + column..]
            .first_chunk()
            .expect(COVERED)
    }
}

/// A block of sums, row by row.
#[repr(align(64))]
struct Block<S>([[S; BLOCK]; BLOCK]);

/// Fills in the field: for each open cell the sum of `rows` and of the transposed
/// `columns`, and 0 elsewhere.
///
/// # Panics
/// If there are fewer sums than whole blocks take.
// Inlined into a sweep, it would spill its registers to the stack.
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
                    let rows = |i| L::load(columns.at(left + x + i, bottom + y));
                    turn::<L, N>(std::array::from_fn(rows), &mut turned, (x, y));
                }
            }
            for (i, turned) in turned.0[..height].iter().enumerate() {
                let y = bottom + i;
                let open = bits.open_word(y, left);
                let to = &mut field[y * bits.columns + left..][..width];
                let row = rows.at(y, left);
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

/// Transposes a square into its place in a block, at these columns and rows.
#[inline(always)]
fn turn<L: Line<N>, const N: usize>(
    square: [L; N],
    block: &mut Block<L::Sum>,
    (x, y): (usize, usize),
) {
    let to = block.0[y..].iter_mut();
    for (row, to) in L::turned(square).into_iter().zip(to) {
        to[x..][..N].copy_from_slice(&row.sums());
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
    let (rows, turned) = (row.as_chunks::<N>().0, turned.as_chunks::<N>().0);
    let to = to.as_chunks_mut::<N>().0.iter_mut();
    for (i, ((row, turned), to)) in rows.iter().zip(turned).zip(to).enumerate() {
        *to = L::load(row).plus(L::load(turned), (open >> (N * i)) as u16);
    }
}
