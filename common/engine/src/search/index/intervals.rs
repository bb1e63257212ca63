//! Ranges that the cells of a small block see in each direction, as intervals.
//!
//! The cells of a 4 × 4 block see one surface, or two where the edge of one hides a part of
//! the other: a near and a far interval of bins hold little more than the cells see.

mod build;
mod pool;
mod strip;
mod strip_blocks;
mod transpose;
mod unpack;
mod wide;

use super::bins::Bins;
use super::block_ids::{BlockIds, quad_of};
use crate::directions::Directions;
use crate::grid::{CellSet, Grid};
use crate::instruction_set::InstructionSet;
use crate::simd::Simd;
use crate::simd::headings::{HEADINGS, IntervalRows};
pub(crate) use crate::simd::{CELLS, SIDE};
use build::Source;
pub(crate) use unpack::{far_start, near_end};
pub(crate) use wide::{ROW_SHIFT, WideViews};

/// Number of directions that are read at a time.
pub(crate) const READ: usize = HEADINGS;

/// Number of rows of a packed block.
const PACKED: usize = 3;

/// A nibble that stands for the width of all that the block sees.
const ALL: u8 = 15;

/// Each entry `(from, by)` means that beyond nibble `from` each nibble stands for a width
/// of `by` more bins than before. Up to the first `from`, a nibble is the width itself.
const STRETCHES: [(u8, u8); 3] = [(4, 1), (8, 6), (12, 8)];

/// Near and far interval of the blocks in which poses are searched, in all directions.
#[derive(Debug, Clone)]
pub(crate) struct RangeIntervals {
    /// Blocks along x.
    pub columns: usize,
    /// Blocks along y.
    pub rows: usize,
    /// Number of directions of a turn.
    pub directions: usize,
    /// Blocks whose intervals are kept.
    pub ids: BlockIds,
    /// Instruction set that unpacks blocks.
    pub(super) simd: Simd,
    /// Three rows for each block that is kept, with a byte for each direction: nearest bin,
    /// farthest bin, and the widths of the two intervals.
    packed: Vec<u8>,
}

/// Intervals of one block, direction by direction for a turn and [`READ`] further ones, so
/// that [`READ`] directions can be read from any one on.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockIntervals {
    /// First and last bin of the near interval, then of the far one. If there is none, the
    /// first is greater than the last.
    pub rows: [Vec<u8>; 4],
}

/// The rows of a block, all of the same length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowsOfBlock<'a>([&'a [u8]; 4]);

impl BlockIntervals {
    /// Returns the rows for reading.
    #[inline(always)]
    pub(crate) fn rows(&self) -> RowsOfBlock<'_> {
        // With one length for all, each place needs to be checked only once.
        let length = self.rows[0].len();
        RowsOfBlock(self.rows.each_ref().map(|row| &row[..length]))
    }
}

impl<'a> RowsOfBlock<'a> {
    /// Returns the rows from a direction on.
    #[inline(always)]
    pub(crate) fn from(&self, direction: usize) -> IntervalRows<'a> {
        const ENOUGH: &str = "a row goes on for as many directions as are read";
        self.0
            .map(|row| row[direction..].first_chunk().expect(ENOUGH))
    }
}

impl RangeIntervals {
    /// Builds the intervals of some blocks of a grid with an instruction set, and the views of
    /// directions in which they are wide.
    pub(crate) fn new(
        grid: &Grid,
        directions: &Directions,
        bins: &Bins,
        ids: BlockIds,
        simd: Simd,
    ) -> (Self, WideViews) {
        let packed = vec![0; PACKED * directions.count() * ids.count()];
        let mut intervals = RangeIntervals {
            columns: grid.width().div_ceil(SIDE),
            rows: grid.height().div_ceil(SIDE),
            directions: directions.count(),
            ids,
            simd,
            packed,
        };
        let source = Source {
            grid,
            directions,
            bins,
            ids: &intervals.ids,
        };
        let views = build::build(source, simd, &mut intervals.packed);
        let wide = WideViews::new(intervals.ids.count(), &views);
        (intervals, wide)
    }

    /// Builds the intervals of all blocks with an instruction set.
    #[cfg(test)]
    pub(crate) fn of_all(
        grid: &Grid,
        directions: &Directions,
        bins: &Bins,
        set: InstructionSet,
    ) -> (Self, WideViews) {
        let blocks = grid.width().div_ceil(SIDE) * grid.height().div_ceil(SIDE);
        let all = BlockIds::of(CellSet::of(blocks, |_| true));
        Self::new(grid, directions, bins, all, Simd::new(set))
    }

    /// Allocates intervals of some blocks of a grid, to be filled in: this many bytes. Returns
    /// `None` if the grid cannot have as many.
    pub(crate) fn unfilled(grid: &Grid, directions: &Directions, bytes: usize) -> Option<Self> {
        let (columns, rows) = (grid.width().div_ceil(SIDE), grid.height().div_ceil(SIDE));
        let most = PACKED * directions.count() * columns * rows;
        (bytes <= most).then(|| RangeIntervals {
            columns,
            rows,
            directions: directions.count(),
            ids: BlockIds::of(CellSet::none(columns * rows)),
            simd: Simd::new(InstructionSet::best()),
            packed: vec![0; bytes],
        })
    }

    /// Returns the set of the blocks and the packed bytes.
    pub(crate) fn parts(&self) -> (&CellSet, &[u8]) {
        (&self.ids.blocks, &self.packed)
    }

    /// Returns the same, to be filled in; [`RangeIntervals::number`] must follow.
    pub(crate) fn parts_mut(&mut self) -> (&mut CellSet, &mut [u8]) {
        (&mut self.ids.blocks, &mut self.packed)
    }

    /// Numbers the blocks that were filled in. Returns true if they are blocks of the grid, and
    /// as many as intervals are packed.
    pub(crate) fn number(&mut self) -> bool {
        self.ids.number();
        let packed = PACKED * self.directions * self.ids.count();
        self.ids.blocks.are_below(self.columns * self.rows) && packed == self.packed.len()
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.packed.len() + self.ids.bytes()
    }

    /// Returns the nearest bins, the farthest bins and the widths of a block that is kept.
    pub(crate) fn packed(&self, block: usize) -> [&[u8]; PACKED] {
        let bytes = PACKED * self.directions;
        let packed = &self.packed[bytes * self.ids.before(block)..][..bytes];
        let (nearest, rest) = packed.split_at(self.directions);
        let (farthest, widths) = rest.split_at(self.directions);
        [nearest, farthest, widths]
    }

    /// Returns the blocks that are kept in a block of twice the side.
    pub(crate) fn quarters(&self, block: usize) -> impl Iterator<Item = usize> {
        let quarters = quad_of(block, (self.columns, self.rows)).into_iter();
        quarters
            .flatten()
            .filter(|&quarter| self.ids.holds(quarter))
    }

    /// Unpacks the intervals of a block that is kept.
    pub(crate) fn read(&self, block: usize, into: &mut BlockIntervals) {
        let packed = self.packed(block);
        let ends = into.rows.each_mut().map(|row| {
            row.resize(self.directions + READ, 0);
            &mut row[..self.directions]
        });
        self.simd.run(unpack::Unpacking { packed, ends });
        for row in &mut into.rows {
            let (turn, further) = row.split_at_mut(self.directions);
            if let (Some(turn), Some(further)) =
                (turn.first_chunk::<READ>(), further.first_chunk_mut())
            {
                *further = *turn;
                continue;
            }
            for further in further.chunks_mut(self.directions) {
                further.copy_from_slice(&turn[..further.len()]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::testing::{any_grid, any_long_grid, space_of};

    proptest! {
        #[test]
        fn intervals_end_with_what_the_cells_see_and_hold_it_all(
            grid in prop_oneof![3 => any_grid(), 1 => any_long_grid()],
            headings in prop_oneof![1u32..12, Just(45)],
        ) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(&grid, directions);
            let with = |set| RangeIntervals::of_all(&grid, directions, &bins, set);
            let (intervals, noted) = with(InstructionSet::Portable);
            let views = |wide: &WideViews, block| wide.of(block).collect::<BTreeMap<_, _>>();
            for set in InstructionSet::available() {
                let (other, others) = with(set);
                prop_assert!(other.packed == intervals.packed, "{}", set);
                for block in 0..intervals.columns * intervals.rows {
                    prop_assert_eq!(views(&others, block), views(&noted, block), "{}", set);
                }
            }
            let mut read = BlockIntervals::default();
            for block in 0..intervals.columns * intervals.rows {
                intervals.read(block, &mut read);
                let views = views(&noted, block);
                for (d, direction) in directions.all().iter().enumerate() {
                    let seen = seen(&grid, &intervals, block, |x, y| {
                        reference::range(&grid, x, y, direction).map(|range| bins.bin(direction.class, range))
                    });
                    let [near_first, near_last, far_first, far_last] = [0, 1, 2, 3].map(|i| read.rows[i][d]);
                    prop_assert_eq!(seen.iter().min().copied().unwrap_or(Bins::NOTHING), near_first);
                    prop_assert_eq!(seen.iter().max().copied().unwrap_or(0), far_last);
                    for bin in &seen {
                        let near = (near_first..=near_last).contains(bin);
                        prop_assert!(near || (far_first..=far_last).contains(bin), "{} {:?}", bin, seen);
                    }
                    // An inner end is seen, too, or is less far from a bin that is seen than the
                    // next smaller width would be.
                    if !seen.is_empty() {
                        let least = |width| (0..ALL).map(unpack::width).rev().find(|&less| less < width);
                        let least = |width| least(width).map_or(0, |less| less + 1);
                        let near = near_first + least(near_last - near_first)..=near_last;
                        let far = far_first..=far_last - least(far_last - far_first);
                        prop_assert!(near_last == far_last || seen.iter().any(|bin| near.contains(bin)));
                        prop_assert!(far_first == near_first || seen.iter().any(|bin| far.contains(bin)));
                        // What is wide for certain is noted, and nothing that cannot be.
                        let widths = [near_last - near_first, far_last - far_first];
                        let sum = |widths: [u8; 2]| widths.map(u16::from).iter().sum::<u16>();
                        let is_noted = views.contains_key(&d);
                        prop_assert!(is_noted || sum(widths.map(least)) < wide::WIDE.into());
                        prop_assert!(!is_noted || sum(widths) >= wide::WIDE.into());
                    }
                    if let Some(rows) = views.get(&d) {
                        let all = seen.iter().fold(0u64, |rows, bin| rows | 1 << (bin >> ROW_SHIFT));
                        prop_assert_eq!(*rows, all);
                    }
                }
                for row in &read.rows {
                    let again = (directions.count()..row.len()).all(|i| row[i] == row[i - directions.count()]);
                    prop_assert!(again && row.len() == directions.count() + READ);
                }
            }
        }
    }

    /// Returns the bins that the open cells of a block see.
    fn seen(
        grid: &Grid,
        intervals: &RangeIntervals,
        block: usize,
        see: impl Fn(i64, i64) -> Option<u8>,
    ) -> Vec<u8> {
        let (left, bottom) = (
            block % intervals.columns * SIDE,
            block / intervals.columns * SIDE,
        );
        let cells =
            (0..SIDE * SIDE).map(|i| ((left + i % SIDE) as i64, (bottom + i / SIDE) as i64));
        cells
            .filter(|&(x, y)| grid.is_open(x, y))
            .filter_map(|(x, y)| see(x, y))
            .collect()
    }
}
