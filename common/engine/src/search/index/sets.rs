//! Ranges that the cells of a block see in each direction, as sets.
//!
//! For each block of cells and each bin of distances, one bit a direction says
//! whether any open cell of the block sees an obstacle at such a distance in
//! that direction. A beam can only vote in a block at headings whose bit is set
//! for a bin that its taper covers, and one row of bits answers that for all
//! headings at once.
//!
//! Two by two blocks are a quad. Their bits are interleaved byte by byte, so that one read
//! serves all four.

mod build;
mod marks;
mod packed;

use std::ops::Range;

use super::block_ids::quad_of;
use super::intervals::{self, RangeIntervals, WideViews};
use crate::directions::Directions;
use crate::grid::{CellSet, Grid};
use crate::simd::words::{BYTES, QUAD};
pub(crate) use packed::SetRows;
use packed::{PackedRows, words};

/// Number of bytes of directions that are read at a time: a word.
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
    /// Blocks in which poses are searched.
    pub searched: CellSet,
    /// Bytes of a row of bits: one bit for each direction. A row stands for
    /// `1 << ROW_SHIFT` bins.
    stride: usize,
    /// Start of the rows of each quad, and at last the end of them all.
    starts: Vec<Start>,
    packed: PackedRows,
}

/// Two by two blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quad {
    pub index: usize,
    /// Blocks that are on the map and bounded.
    pub blocks: [Option<usize>; QUAD],
}

/// Start of the rows of a quad.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Start {
    /// Rows and kept bytes of all quads before this one.
    row: u32,
    byte: u32,
    /// First row that has any bits.
    first: u32,
}

impl RangeSets {
    /// Builds the sets of blocks of 2 × 2 blocks of intervals, with the instruction set of these.
    pub(crate) fn new(intervals: &RangeIntervals, wide: &WideViews) -> Self {
        let (columns, rows) = (intervals.columns.div_ceil(2), intervals.rows.div_ceil(2));
        let (side, stride) = (2 * intervals::SIDE, intervals.directions / 8);
        let mut sets = Self::without_quads(side, (columns, rows), stride);
        sets.search_in(&intervals.ids.blocks, intervals.columns);
        intervals.simd.run(build::Joining(intervals, wide, sets))
    }

    fn without_quads(side: usize, (columns, rows): (usize, usize), stride: usize) -> Self {
        RangeSets {
            side,
            columns,
            rows,
            searched: CellSet::none(columns * rows),
            stride,
            starts: Vec::with_capacity(columns.div_ceil(2) * rows.div_ceil(2) + 1),
            packed: PackedRows::default(),
        }
    }

    /// Searches the blocks of which any quarter is one of these.
    fn search_in(&mut self, quarters: &CellSet, columns: usize) {
        for quarter in quarters.iter() {
            let (x, y) = (quarter % columns, quarter / columns);
            self.searched.insert(y / 2 * self.columns + x / 2);
        }
    }

    /// Adds a quad with these rows, each of which `row` fills in.
    fn push(
        &mut self,
        rows: Range<usize>,
        turn: &mut [Byte],
        mut row: impl FnMut(usize, &mut [Byte]),
    ) {
        self.starts.push(self.next(rows.start));
        for i in rows {
            row(i, turn);
            self.packed.push(turn);
        }
    }

    /// Returns the start of the next quad.
    fn next(&self, first: usize) -> Start {
        Start {
            row: (self.packed.masks.len() / words(self.stride)) as u32,
            byte: self.packed.bytes.len() as u32,
            first: first as u32,
        }
    }

    /// Ends the quads.
    fn finished(mut self) -> Self {
        self.starts.push(self.next(0));
        self.packed.finish();
        self
    }

    /// Allocates sets of blocks with this many cells a side, to be filled in, with these
    /// numbers of bytes: starts of quads, masks, and bytes that are kept. Returns `None` if the
    /// grid cannot have as many.
    pub(crate) fn unfilled(
        side: usize,
        grid: &Grid,
        directions: &Directions,
        [starts, masks, bytes]: [usize; 3],
    ) -> Option<Self> {
        let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
        let quads = columns.div_ceil(2) * rows.div_ceil(2);
        let stride = directions.count() / 8;
        let most_rows = quads << (u8::BITS - intervals::ROW_SHIFT);
        let masks = count::<u16>(masks).filter(|&masks| masks <= most_rows * words(stride))?;
        let bytes = count::<Byte>(bytes).filter(|&bytes| bytes <= most_rows * stride + READ)?;
        (count::<Start>(starts) == Some(quads + 1)).then(|| RangeSets {
            side,
            columns,
            rows,
            searched: CellSet::none(columns * rows),
            stride,
            starts: vec![Start::default(); quads + 1],
            packed: PackedRows {
                masks: vec![0; masks],
                bytes: vec![[0; QUAD]; bytes],
            },
        })
    }

    /// Returns the set of the blocks, the starts of quads, the masks, and the bytes that are kept.
    pub(crate) fn parts(&self) -> [&[u8]; 4] {
        let PackedRows { masks, bytes } = &self.packed;
        let searched = bytemuck::cast_slice(self.searched.words());
        let starts = bytemuck::cast_slice(&self.starts);
        [
            searched,
            starts,
            bytemuck::cast_slice(masks),
            bytes.as_flattened(),
        ]
    }

    /// Returns the same, to be filled in.
    pub(crate) fn parts_mut(&mut self) -> [&mut [u8]; 4] {
        let PackedRows { masks, bytes } = &mut self.packed;
        let searched = bytemuck::cast_slice_mut(self.searched.words_mut());
        let starts = bytemuck::cast_slice_mut(&mut self.starts);
        let masks = bytemuck::cast_slice_mut(masks);
        [searched, starts, masks, bytes.as_flattened_mut()]
    }

    /// True if the sections that were filled in can be read: the quads follow each other, no
    /// row is beyond the last bin, and as many bytes are kept of each quad as its masks say.
    pub(crate) fn are_sound(&self) -> bool {
        let PackedRows { masks, bytes } = &self.packed;
        let words = words(self.stride);
        let mut masks = &masks[..];
        let are_sound = self.starts.windows(2).all(|pair| {
            let [start, end] = [pair[0], pair[1]];
            let rows = end.row.checked_sub(start.row).unwrap_or(u32::MAX);
            let last_row = start.first.saturating_add(rows);
            let Some((own, rest)) = masks.split_at_checked(rows as usize * words) else {
                return false;
            };
            masks = rest;
            let kept: u32 = own.iter().map(|mask| mask.count_ones()).sum();
            last_row <= 1 << (u8::BITS - intervals::ROW_SHIFT)
                && end.byte.checked_sub(start.byte) == Some(kept)
        });
        let first = self.starts.first().map(|start| (start.row, start.byte));
        let last = self.starts.last().map(|end| end.byte as usize + READ);
        are_sound && masks.is_empty() && first == Some((0, 0)) && last == Some(bytes.len())
    }

    /// Builds the sets of blocks of twice the side, each joined from two by two of these.
    pub(crate) fn joined(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let quads = (columns.div_ceil(2), rows.div_ceil(2));
        let mut joined = Self::without_quads(2 * self.side, (columns, rows), self.stride);
        joined.search_in(&self.searched, self.columns);
        let mut turn = vec![[0; QUAD]; self.stride];
        let mut unpacked = [(); QUAD].map(|()| Vec::new());
        for quad in 0..quads.0 * quads.1 {
            // A block is a quad of these.
            let within = quad_of(quad, (columns, rows)).map(|block| Some(self.quad(block?)));
            let all = within.iter().flatten().map(|quad| quad.rows.clone());
            let all = all.filter(|rows| !rows.is_empty());
            let all = all.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
            for (quad, unpacked) in within.iter().zip(&mut unpacked) {
                quad.iter().for_each(|quad| quad.unpack(unpacked));
            }
            joined.push(all.unwrap_or(0..0), &mut turn, |row, turn| {
                turn.fill([0; QUAD]);
                for (place, (quad, unpacked)) in within.iter().zip(&unpacked).enumerate() {
                    let quad = quad.as_ref().filter(|quad| quad.rows.contains(&row));
                    let Some(quad) = quad else { continue };
                    let row = &unpacked[(row - quad.rows.start) * self.stride..];
                    for (to, &byte) in turn.iter_mut().zip(row) {
                        let any = u32::from_ne_bytes(byte);
                        let any = any | any >> 16;
                        to[place] = (any | any >> 8) as u8;
                    }
                }
            });
        }
        joined.finished()
    }

    pub(crate) fn blocks(&self) -> usize {
        self.columns * self.rows
    }

    pub(crate) fn quads(&self) -> usize {
        self.starts.len() - 1
    }

    /// Returns a quad with those of its blocks in which poses are searched.
    pub(crate) fn searched_quad(&self, index: usize) -> Quad {
        let blocks = quad_of(index, (self.columns, self.rows));
        let blocks = blocks.map(|block| block.filter(|&block| self.searched.holds(block)));
        Quad { index, blocks }
    }

    /// Returns the quad of a block with that block alone, and the block's place in it.
    pub(crate) fn alone(&self, block: usize) -> (Quad, usize) {
        let (x, y) = (block % self.columns, block / self.columns);
        let index = y / 2 * self.columns.div_ceil(2) + x / 2;
        let place = y % 2 * 2 + x % 2;
        let mut blocks = [None; QUAD];
        blocks[place] = Some(block);
        (Quad { index, blocks }, place)
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.searched.bytes() + self.packed.size() + size_of_val(&self.starts[..])
    }

    pub(crate) fn quad(&self, quad: usize) -> SetRows<'_> {
        let (start, end) = (self.starts[quad], self.starts[quad + 1]);
        let (row, rows) = (start.row as usize, (end.row - start.row) as usize);
        let (first, words) = (start.first as usize, words(self.stride));
        SetRows {
            rows: first..first + rows,
            stride: self.stride,
            masks: &self.packed.masks[row * words..(row + rows) * words],
            bytes: &self.packed.bytes[start.byte as usize..end.byte as usize + READ],
        }
    }
}

impl Quad {
    /// Returns the blocks, each after its place in the quad.
    pub(crate) fn blocks(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let blocks = self.blocks.into_iter().enumerate();
        blocks.filter_map(|(place, block)| Some((place, block?)))
    }
}

/// Returns how many `T` this many bytes are; `None` if it is no whole number.
fn count<T>(bytes: usize) -> Option<usize> {
    let each = size_of::<T>();
    bytes.is_multiple_of(each).then_some(bytes / each)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::instruction_set::InstructionSet;
    use crate::reference;
    use crate::search::index::bins::Bins;
    use crate::testing::{any_grid, space_of};

    /// Returns a row as it was before it was packed, if it is kept.
    fn row_of(rows: &SetRows<'_>, row: usize) -> Option<Vec<Byte>> {
        let mut unpacked = Vec::new();
        rows.unpack(&mut unpacked);
        let stride = unpacked.len().checked_div(rows.rows.len())?;
        let is_held = rows.rows.contains(&row);
        is_held.then(|| unpacked[(row - rows.rows.start) * stride..][..stride].to_vec())
    }

    proptest! {
        #[test]
        fn sets_hold_the_bins_of_all_cells_on_every_instruction_set(
            grid in any_grid(), headings in prop_oneof![1u32..12, Just(45)],
        ) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(&grid, directions);
            let with = |set| {
                let (intervals, wide) = RangeIntervals::of_all(&grid, directions, &bins, set);
                RangeSets::new(&intervals, &wide)
            };
            let fine = with(InstructionSet::Portable);
            for set in InstructionSet::available() {
                let other = with(set);
                prop_assert!(other.packed == fine.packed && other.starts == fine.starts, "{}", set);
            }
            for sets in [&fine, &fine.joined()] {
                for (y, x) in (0..grid.height()).flat_map(|y| (0..grid.width()).map(move |x| (y, x))) {
                    let (quad, place) = sets.alone(y / sets.side * sets.columns + x / sets.side);
                    let rows = sets.quad(quad.index);
                    for (d, direction) in directions.all().iter().enumerate() {
                        let range = reference::range(&grid, x as i64, y as i64, direction);
                        let Some(range) = range.filter(|&range| range > 0) else { continue };
                        let row = usize::from(bins.bin(direction.class, range) >> intervals::ROW_SHIFT);
                        let bits = row_of(&rows, row).map_or(0, |row| row[d / 8][place]);
                        prop_assert!(bits >> (d % 8) & 1 == 1);
                    }
                }
            }
        }
    }
}
