//! Which ranges the cells of a block see in each direction, as sets.
//!
//! For each block of cells and each bin of distances, one bit a direction says
//! whether any open cell of the block sees an obstacle at such a distance in
//! that direction. A beam can only vote in a block at headings whose bit is set
//! for a bin that its taper covers, and one row of bits answers that for all
//! headings at once.

mod build;
mod marks;

use crate::instruction_set::InstructionSet;
use crate::search::intervals::{self, RangeIntervals};
use crate::search::prefetch::prefetch;
use crate::search::spans::READ;
use build::{BitRows, build};

/// The visible ranges of all blocks of one size.
#[derive(Debug, Clone)]
pub(crate) struct RangeSets {
    /// Cells along the side of a block.
    pub side: usize,
    /// Blocks along x.
    pub columns: usize,
    /// Blocks along y.
    pub rows: usize,
    /// A bit stands for `1 << shift` bins of [`crate::search::bins::Bins`].
    pub shift: u32,
    /// Bytes of a row of bits: one bit for each direction.
    stride: usize,
    /// The rows of block `b` are `starts[b]..starts[b + 1]`.
    starts: Vec<u32>,
    bits: Vec<u8>,
}

/// The rows of one block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlockRows<'a> {
    /// How many there are.
    pub count: usize,
    /// Row by row; behind the last one, [`READ`] bytes more than a row can be
    /// read.
    pub bytes: &'a [u8],
}

impl RangeSets {
    /// Those of blocks of 2 × 2 blocks of intervals.
    pub(crate) fn new(intervals: &RangeIntervals, shift: u32) -> Self {
        Self::with(intervals, shift, InstructionSet::best(), 1)
    }

    /// The same by a given instruction set and number of threads.
    pub(crate) fn with(
        intervals: &RangeIntervals,
        shift: u32,
        set: InstructionSet,
        threads: usize,
    ) -> Self {
        let (columns, rows) = (intervals.columns.div_ceil(2), intervals.rows.div_ceil(2));
        let of = |rows| build(set, intervals, shift, rows);
        let piece = rows.div_ceil(threads.max(1));
        let bits = std::thread::scope(|scope| {
            let others: Vec<_> = (piece..rows)
                .step_by(piece)
                .map(|start| scope.spawn(move || of(start..rows.min(start + piece))))
                .collect();
            let mut all = of(0..piece);
            for other in others {
                let mut other = other
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
                all.rows.append(&mut other.rows);
                all.bits.append(&mut other.bits);
            }
            all
        });
        let side = 2 * intervals::SIDE;
        Self::of_rows(side, (columns, rows), shift, intervals.directions / 8, bits)
    }

    fn of_rows(
        side: usize,
        (columns, rows): (usize, usize),
        shift: u32,
        stride: usize,
        mut rows_of: BitRows,
    ) -> Self {
        let mut starts = vec![0];
        let mut end = 0;
        for rows in rows_of.rows {
            end += rows;
            starts.push(end);
        }
        rows_of.bits.resize(rows_of.bits.len() + stride + READ, 0);
        rows_of.bits.shrink_to_fit();
        RangeSets {
            side,
            columns,
            rows,
            shift,
            stride,
            starts,
            bits: rows_of.bits,
        }
    }

    /// Those of blocks that join two by two of these, with bits that stand for
    /// twice as many bins.
    pub(crate) fn joined(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let mut joined = BitRows::default();
        let mut bits = Vec::new();
        for y in 0..rows {
            for x in 0..columns {
                bits.clear();
                for i in 0..4 {
                    let (x, y) = (2 * x + i % 2, 2 * y + i / 2);
                    if x < self.columns && y < self.rows {
                        unite(&mut bits, self.bits_of(y * self.columns + x));
                    }
                }
                let pairs = bits.chunks(2 * self.stride);
                joined.rows.push(pairs.len() as u32);
                for pair in pairs {
                    let (near, far) = pair.split_at(self.stride);
                    let start = joined.bits.len();
                    joined.bits.extend_from_slice(near);
                    for (bits, far) in joined.bits[start..].iter_mut().zip(far) {
                        *bits |= far;
                    }
                }
            }
        }
        Self::of_rows(
            2 * self.side,
            (columns, rows),
            self.shift + 1,
            self.stride,
            joined,
        )
    }

    /// How many blocks there are.
    pub(crate) fn blocks(&self) -> usize {
        self.columns * self.rows
    }

    /// Bytes that the sets take.
    pub(crate) fn bytes(&self) -> usize {
        self.bits.len() + 4 * self.starts.len()
    }

    /// The rows of bits of a block, from the nearest bin on.
    pub(crate) fn block(&self, block: usize) -> BlockRows<'_> {
        let (start, end) = (self.starts[block] as usize, self.starts[block + 1] as usize);
        BlockRows {
            count: end - start,
            bytes: &self.bits[start * self.stride..],
        }
    }

    /// Asks for the rows of a block that is soon to be read.
    pub(crate) fn prefetch(&self, block: usize) {
        prefetch(self.bits_of(block));
    }

    fn bits_of(&self, block: usize) -> &[u8] {
        let BlockRows { count, bytes } = self.block(block);
        &bytes[..count * self.stride]
    }
}

/// Adds rows of bits to others, which may be fewer.
fn unite(all: &mut Vec<u8>, bits: &[u8]) {
    let both = all.len().min(bits.len());
    for (all, bits) in all.iter_mut().zip(bits) {
        *all |= bits;
    }
    all.extend_from_slice(&bits[both..]);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::search::bins::Bins;
    use crate::testing::{any_grid, space_of};

    proptest! {
        #[test]
        fn sets_hold_the_bins_of_all_cells_on_every_instruction_set(
            grid in any_grid(), headings in prop_oneof![1u32..12, Just(45)], shift in 0u32..3,
        ) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(directions);
            let intervals = RangeIntervals::new(&grid, directions, &bins);
            let fine = RangeSets::with(&intervals, shift, InstructionSet::Portable, 1);
            for set in InstructionSet::available() {
                for threads in 1..4 {
                    let other = RangeSets::with(&intervals, shift, set, threads);
                    prop_assert!(other.bits == fine.bits && other.starts == fine.starts, "{} {}", set, threads);
                }
            }
            for sets in [&fine, &fine.joined()] {
                for (y, x) in (0..grid.height()).flat_map(|y| (0..grid.width()).map(move |x| (y, x))) {
                    let rows = sets.bits_of(y / sets.side * sets.columns + x / sets.side);
                    for (d, direction) in directions.all().iter().enumerate() {
                        let range = reference::range(&grid, x as i64, y as i64, direction);
                        let Some(range) = range.filter(|&range| range > 0) else { continue };
                        let row = usize::from(bins.bin(direction.class, range) >> sets.shift);
                        prop_assert!(rows[row * sets.stride + d / 8] >> (d % 8) & 1 == 1);
                    }
                }
            }
        }

        #[test]
        fn sets_hold_nothing_but_the_intervals(grid in any_grid(), headings in 1u32..10, shift in 0u32..3) {
            let directions = &space_of(&grid, headings * 8).directions;
            let intervals = RangeIntervals::new(&grid, directions, &Bins::new(directions));
            let sets = RangeSets::new(&intervals, shift);
            let mut plain = vec![Vec::new(); sets.blocks()];
            let mut read = intervals::BlockIntervals::default();
            for block in 0..intervals.columns * intervals.rows {
                intervals.read(block, &mut read);
                let (x, y) = (block % intervals.columns, block / intervals.columns);
                let rows: &mut Vec<u8> = &mut plain[y / 2 * sets.columns + x / 2];
                for d in 0..directions.count() {
                    let [near_first, near_last, far_first, far_last] = [0, 1, 2, 3].map(|i| read.rows[i][d]);
                    for bin in (near_first..=near_last).chain(far_first..=far_last) {
                        let at = usize::from(bin >> shift) * sets.stride;
                        rows.resize(rows.len().max(at + sets.stride), 0);
                        rows[at + d / 8] |= 1 << (d % 8);
                    }
                }
            }
            for (block, plain) in plain.iter().enumerate() {
                prop_assert_eq!(sets.bits_of(block), &plain[..]);
            }
        }
    }
}
