//! Which ranges the cells of a block see in each direction, as sets.
//!
//! For each block of cells and each bin of distances, one bit a direction says
//! whether any open cell of the block sees an obstacle at such a distance in
//! that direction. A beam can only vote in a block at headings whose bit is set
//! for a bin that its taper covers, and one row of bits answers that for all
//! headings at once.
//!
//! Two by two blocks are a quad. Their bits lie side by side, byte by byte, so that
//! what is read of one is read of all.

mod build;
mod marks;

use std::convert::Infallible;
use std::ops::Range;

use crate::instruction_set::InstructionSet;
use crate::search::bits::QUAD;
use crate::search::intervals::{self, RangeIntervals, WideViews};
use crate::search::prefetch::prefetch;
use crate::search::words::BYTES;
use crate::threads;
use build::{Rows, build};

/// Bytes of directions that are read at a time: a word.
pub(crate) const READ: usize = BYTES / QUAD;

/// The bits of eight directions in each block of a quad.
pub(crate) type Byte = [u8; QUAD];

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
    /// Where the rows of each quad start, and behind them where the last ones end.
    starts: Vec<Start>,
    bits: Vec<Byte>,
}

/// Two by two blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quad {
    pub index: usize,
    /// Those that are on the map and wanted.
    pub blocks: [Option<usize>; QUAD],
}

/// Where the rows of a quad start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Start {
    /// Counted through all quads.
    at: u32,
    /// The first row that has any bits.
    first: u32,
}

/// The rows of a quad.
#[derive(Debug, Clone)]
pub(crate) struct SetRows<'a> {
    /// Those that have any bits, from the nearest bin on.
    pub rows: Range<usize>,
    stride: usize,
    /// Behind the last row, [`READ`] bytes more than it has can be read.
    bytes: &'a [Byte],
}

impl RangeSets {
    /// Those of blocks of 2 × 2 blocks of intervals.
    pub(crate) fn new(intervals: &RangeIntervals, wide: &WideViews) -> Self {
        Self::with(intervals, wide, InstructionSet::best(), 1)
    }

    /// The same by a given instruction set and number of threads.
    pub(crate) fn with(
        intervals: &RangeIntervals,
        wide: &WideViews,
        set: InstructionSet,
        threads: usize,
    ) -> Self {
        let (columns, rows) = (intervals.columns.div_ceil(2), intervals.rows.div_ceil(2));
        let quad_rows = rows.div_ceil(2);
        let piece = quad_rows.div_ceil(threads);
        let pieces = (0..quad_rows).step_by(piece);
        let pieces = pieces.map(|start| (start..quad_rows.min(start + piece), Rows::default()));
        let mut pieces: Vec<_> = pieces.collect();
        let Ok(()) = threads::run(&mut pieces, &|| false, |_, (rows, built), _| {
            *built = build(set, (intervals, wide), rows.clone());
            Ok::<(), Infallible>(())
        });
        let mut pieces = pieces.into_iter().map(|(_, built)| built);
        let mut rows_of = pieces.next().unwrap_or_default();
        for mut piece in pieces {
            rows_of.rows.append(&mut piece.rows);
            rows_of.bits.append(&mut piece.bits);
        }
        let side = 2 * intervals::SIDE;
        let stride = intervals.directions / 8;
        Self::of_rows(side, (columns, rows), intervals::ROW_SHIFT, stride, rows_of)
    }

    fn of_rows(
        side: usize,
        (columns, rows): (usize, usize),
        shift: u32,
        stride: usize,
        mut rows_of: Rows,
    ) -> Self {
        let mut starts = Vec::with_capacity(rows_of.rows.len() + 1);
        let mut at = 0;
        for rows in rows_of.rows {
            starts.push(Start {
                at,
                first: rows.start as u32,
            });
            at += rows.len() as u32;
        }
        starts.push(Start { at, first: 0 });
        rows_of.bits.resize(rows_of.bits.len() + READ, [0; QUAD]);
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
        let quads = (columns.div_ceil(2), rows.div_ceil(2));
        let mut joined = Rows::default();
        for quad in 0..quads.0 * quads.1 {
            // A block is a quad of these.
            let within = quad_of(quad, (columns, rows)).map(|block| Some(self.quad(block?)));
            let all = within.iter().flatten().map(|quad| quad.rows.clone());
            let all = all.filter(|rows| !rows.is_empty());
            let all = all.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
            let all = all.map_or(0..0, |rows| rows.start / 2..rows.end.div_ceil(2));
            for row in all.clone() {
                let pairs = within
                    .each_ref()
                    .map(|quad| [2 * row, 2 * row + 1].map(|row| quad.as_ref()?.from(row)));
                let any = |pair: [Option<&[Byte]>; 2], byte: usize| {
                    let words = pair.map(|row| row.map_or(0, |row| u32::from_ne_bytes(row[byte])));
                    let both = words[0] | words[1];
                    let both = both | both >> 16;
                    (both | both >> 8) as u8
                };
                let turn = (0..self.stride).map(|byte| pairs.map(|pair| any(pair, byte)));
                joined.bits.extend(turn);
            }
            joined.rows.push(all);
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

    /// How many quads there are.
    pub(crate) fn quads(&self) -> usize {
        self.starts.len() - 1
    }

    /// A quad, for those of its blocks that are wanted.
    pub(crate) fn sought(&self, quad: usize, wanted: impl Fn(usize) -> bool) -> Quad {
        let blocks = quad_of(quad, (self.columns, self.rows));
        Quad {
            index: quad,
            blocks: blocks.map(|block| block.filter(|&block| wanted(block))),
        }
    }

    /// Where a block lies: its quad, and its place there.
    pub(crate) fn place_of(&self, block: usize) -> (usize, usize) {
        let (x, y) = (block % self.columns, block / self.columns);
        let quad = y / 2 * self.columns.div_ceil(2) + x / 2;
        (quad, y % 2 * 2 + x % 2)
    }

    /// Bytes that the sets take.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.bits[..]) + size_of_val(&self.starts[..])
    }

    /// The rows of a quad.
    pub(crate) fn quad(&self, quad: usize) -> SetRows<'_> {
        let (start, end) = (self.starts[quad], self.starts[quad + 1]);
        let (at, end, first) = (start.at as usize, end.at as usize, start.first as usize);
        SetRows {
            rows: first..first + end - at,
            stride: self.stride,
            bytes: &self.bits[at * self.stride..end * self.stride + READ],
        }
    }

    /// Asks for the rows of a quad that is soon to be read.
    pub(crate) fn prefetch(&self, quad: usize) {
        prefetch(self.quad(quad).bytes.as_flattened());
    }
}

impl Quad {
    /// The blocks that are wanted, and their places.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let blocks = self.blocks.into_iter().enumerate();
        blocks.filter_map(|(place, block)| Some((place, block?)))
    }
}

impl<'a> SetRows<'a> {
    /// The bytes from a row on, if it has bits.
    #[inline(always)]
    pub(crate) fn from(&self, row: usize) -> Option<&'a [Byte]> {
        let is_any = self.rows.contains(&row);
        is_any.then(|| &self.bytes[(row - self.rows.start) * self.stride..])
    }
}

/// The blocks of a quad on a map of so many columns and rows of blocks.
fn quad_of(quad: usize, (columns, rows): (usize, usize)) -> [Option<usize>; QUAD] {
    let quads = columns.div_ceil(2);
    let (left, bottom) = (2 * (quad % quads), 2 * (quad / quads));
    std::array::from_fn(|place| {
        let (x, y) = (left + place % 2, bottom + place / 2);
        (x < columns && y < rows).then(|| y * columns + x)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::search::bins::Bins;
    use crate::search::bits;
    use crate::search::steps::BinSteps;
    use crate::testing::{any_grid, space_of};

    proptest! {
        #[test]
        fn sets_hold_the_bins_of_all_cells_on_every_instruction_set(
            grid in any_grid(), headings in prop_oneof![1u32..12, Just(45)],
        ) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(directions);
            let steps = BinSteps::new(&bins, directions, grid.width().max(grid.height()) as u16);
            let (intervals, wide) = RangeIntervals::new(&grid, directions, (&bins, &steps));
            let fine = RangeSets::with(&intervals, &wide, InstructionSet::Portable, 1);
            for set in InstructionSet::available() {
                for threads in 1..4 {
                    let other = RangeSets::with(&intervals, &wide, set, threads);
                    prop_assert!(other.bits == fine.bits && other.starts == fine.starts, "{} {}", set, threads);
                }
            }
            for sets in [&fine, &fine.joined()] {
                for (y, x) in (0..grid.height()).flat_map(|y| (0..grid.width()).map(move |x| (y, x))) {
                    let (quad, place) = sets.place_of(y / sets.side * sets.columns + x / sets.side);
                    let rows = sets.quad(quad);
                    for (d, direction) in directions.all().iter().enumerate() {
                        let range = reference::range(&grid, x as i64, y as i64, direction);
                        let Some(range) = range.filter(|&range| range > 0) else { continue };
                        let row = usize::from(bins.bin(direction.class, range) >> sets.shift);
                        let bits = rows.from(row).map_or(0, |row| row[d / 8][place]);
                        prop_assert!(bits >> (d % 8) & 1 == 1);
                    }
                }
            }
        }

        #[test]
        fn sets_hold_nothing_but_the_intervals_and_wide_views(grid in any_grid(), headings in 1u32..10) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(directions);
            let steps = BinSteps::new(&bins, directions, grid.width().max(grid.height()) as u16);
            let (intervals, wide) = RangeIntervals::new(&grid, directions, (&bins, &steps));
            let sets = RangeSets::new(&intervals, &wide);
            let mut plain = vec![Vec::new(); sets.blocks()];
            let mut read = intervals::BlockIntervals::default();
            for block in 0..intervals.columns * intervals.rows {
                intervals.read(block, &mut read);
                let (x, y) = (block % intervals.columns, block / intervals.columns);
                let rows: &mut Vec<u8> = &mut plain[y / 2 * sets.columns + x / 2];
                for d in 0..directions.count() {
                    let [near_first, near_last, far_first, far_last] = [0, 1, 2, 3].map(|i| read.rows[i][d]);
                    let within = (near_first..=near_last).chain(far_first..=far_last);
                    let seen: Vec<usize> = match wide.of(block).find(|&(direction, _)| direction == d) {
                        Some((_, rows)) => bits::ones(rows).collect(),
                        None => within.map(|bin| usize::from(bin >> sets.shift)).collect(),
                    };
                    for row in seen {
                        let at = row * sets.stride;
                        rows.resize(rows.len().max(at + sets.stride), 0);
                        rows[at + d / 8] |= 1 << (d % 8);
                    }
                }
            }
            for quad in 0..sets.quads() {
                let rows = sets.quad(quad);
                let mut any = 0..0;
                for row in 0..=usize::from(u8::MAX) {
                    let of_block = |block: Option<usize>| {
                        let rows = plain.get(block?)?.get(row * sets.stride..)?;
                        rows.get(..sets.stride)
                    };
                    let blocks = sets.sought(quad, |_| true).blocks.map(of_block);
                    let turn = (0..sets.stride).map(|byte| blocks.map(|row| row.map_or(0, |row| row[byte])));
                    let turn: Vec<Byte> = turn.collect();
                    if turn.as_flattened().iter().any(|&byte| byte != 0) {
                        any = if any.is_empty() { row..row + 1 } else { any.start..row + 1 };
                        prop_assert_eq!(rows.from(row).map(|row| &row[..sets.stride]), Some(&turn[..]));
                    }
                }
                prop_assert_eq!(rows.rows, any);
            }
        }
    }
}
