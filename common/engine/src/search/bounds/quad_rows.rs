//! The sets of a quad of blocks, laid out so that windows of bins are read quickly.
//!
//! Each row holds a full turn and one word more, so that a word can be read from any
//! direction on.

use std::ops::Range;

use crate::search::index::bins::Bins;
use crate::search::index::bits::CHUNK;
use crate::search::index::intervals::ROW_SHIFT;
use crate::search::index::sets::{Byte, READ, SetRows};
use crate::simd::Set;
use crate::simd::words::{BYTES, QUAD, Words};

/// Layout of rows in memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct RowLayout {
    /// Bytes of a full turn, 8 directions each.
    stride: usize,
    /// Bytes from a row to the next one.
    row: usize,
    /// Largest number of rows. A row without bits follows them.
    most: usize,
    /// Range of the rows that are read.
    needed: Range<usize>,
    /// Place within a turn of each byte of two turns.
    turns: Vec<u32>,
}

/// A range of rows to be read at a beam's bearing, rounded down to a multiple of 8.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    /// Starts of the first and the last row that is read.
    first: u32,
    last: u32,
    /// Bearing divided by 8.
    byte: u32,
    /// Number of reads.
    pub reads: u32,
}

/// The rows of a quad.
#[derive(Debug, Clone, Default)]
pub(crate) struct QuadRows {
    bytes: Vec<Byte>,
    /// Range of the rows that may have bits.
    used: Range<usize>,
}

/// Extent of some windows in memory.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Extent {
    /// End of their bytes, and the start of the farthest of their rows.
    bytes: usize,
    rows: usize,
}

/// The rows of a quad, for reading windows within an [`Extent`] that was checked, at the
/// headings of a chunk.
#[derive(Clone, Copy)]
pub(crate) struct Windows<'a> {
    layout: &'a RowLayout,
    bytes: &'a [Byte],
    /// First byte of the chunk.
    start: usize,
}

impl RowLayout {
    /// Starts a new layout without windows.
    pub(crate) fn start(&mut self, directions: usize) {
        self.stride = directions / 8;
        let turns = (READ - 1).div_ceil(self.stride);
        self.row = (turns * self.stride + READ).next_multiple_of(READ);
        self.most = (usize::from(Bins::NOTHING) >> ROW_SHIFT) + 1;
        self.needed = self.most..0;
        let turn = 0..self.stride as u32;
        self.turns.clear();
        self.turns.extend(turn.clone().chain(turn));
    }

    /// Adds a window of rows from direction `8 · byte` on, and returns it.
    pub(crate) fn window(&mut self, rows: Range<usize>, byte: usize) -> Window {
        assert!(
            byte < self.stride && rows.end <= self.most,
            "it lies within the rows"
        );
        let needed = &self.needed;
        self.needed = needed.start.min(rows.start)..needed.end.max(rows.end);
        Window {
            first: (rows.start * self.row) as u32,
            last: (rows.end.saturating_sub(1).max(rows.start) * self.row) as u32,
            byte: byte as u32,
            reads: rows.len() as u32,
        }
    }

    /// Returns a window that sees nothing.
    pub(crate) fn nothing(&self) -> Window {
        let start = (self.most * self.row) as u32;
        Window {
            first: start,
            last: start,
            byte: 0,
            reads: 1,
        }
    }

    /// Returns the end of all rows, including the one without bits.
    fn end(&self) -> usize {
        (self.most + 1) * self.row
    }
}

impl QuadRows {
    /// Allocates buffers for a layout; drops the rows of an earlier one.
    pub(crate) fn fit(&mut self, layout: &RowLayout) {
        self.bytes.clear();
        self.bytes.resize(layout.end(), [0; QUAD]);
        self.used = 0..0;
    }

    /// Replaces the rows by those of a quad.
    #[inline(always)]
    pub(crate) fn take<S: Set>(&mut self, set: S, layout: &RowLayout, rows: &SetRows<'_>) {
        let (row, stride) = (layout.row, layout.stride);
        let (first, end) = (rows.rows.start, rows.rows.end);
        let taken = first.max(layout.needed.start)..end.min(layout.needed.end);
        let mut kept = rows.kept_before(taken.start);
        for i in taken.clone() {
            let own = &mut self.bytes[i * row..][..row];
            for (start, &mask) in (0..stride).step_by(READ).zip(rows.masks_of(i)) {
                let words = set.expand(mask, bytes(&rows.bytes[kept..]));
                words.write(bytes_mut(&mut own[start..]));
                kept += mask.count_ones() as usize;
            }
            go_round(own, stride);
        }
        for used in self.used.clone() {
            if !taken.contains(&used) {
                self.bytes[used * row..][..row].fill([0; QUAD]);
            }
        }
        self.used = taken;
    }
}

/// Repeats a row's turn, so that words can be read from any byte of the first turn on.
#[inline(always)]
fn go_round(row: &mut [Byte], stride: usize) {
    let turn = Words::read(bytes(row));
    // Bytes copied in excess are overwritten by the next turn.
    for start in (stride..stride + READ - 1).step_by(stride) {
        turn.write(bytes_mut(&mut row[start..]));
    }
}

#[inline(always)]
fn bytes(of: &[Byte]) -> &[u8; BYTES] {
    bytemuck::cast_ref(of.first_chunk::<READ>().expect("a word"))
}

#[inline(always)]
fn bytes_mut(of: &mut [Byte]) -> &mut [u8; BYTES] {
    bytemuck::cast_mut(of.first_chunk_mut::<READ>().expect("a word"))
}

impl Extent {
    /// Extends this to a window.
    pub(crate) fn take(&mut self, window: &Window) {
        self.bytes = self.bytes.max(window.byte as usize + 1);
        self.rows = self.rows.max(window.last as usize);
    }
}

impl<'a> Windows<'a> {
    /// Returns windows in the rows of a chunk, none of which goes further than `extent`.
    ///
    /// # Panics
    /// If the extent or the chunk goes further than the rows.
    #[inline(always)]
    pub(crate) fn new(
        (layout, rows, chunk): (&'a RowLayout, &'a QuadRows, usize),
        extent: &Extent,
    ) -> Self {
        let (start, stride, end) = (chunk * (CHUNK / 8), layout.stride, layout.end());
        assert!(start < stride && rows.bytes.len() >= end);
        assert!(extent.bytes <= stride && extent.rows + stride + READ <= end);
        Windows {
            layout,
            bytes: &rows.bytes[..end],
            start,
        }
    }

    /// Reads the bits of a window with `reads` reads, in the order of sets, see
    /// [`Set::sorted`]. More reads than needed change nothing.
    ///
    /// # Safety
    /// The extent within which windows are read must have taken this one in.
    #[inline(always)]
    pub(crate) unsafe fn read(&self, window: &Window, reads: u32) -> Words {
        let Windows {
            layout,
            bytes,
            start: chunk,
        } = *self;
        // SAFETY: a window's byte and the start of a chunk are less than a turn each, as
        // was asserted of the extent and of the chunk.
        let place = unsafe { *layout.turns.get_unchecked(chunk + window.byte as usize) } as usize;
        let last = window.last as usize;
        let mut start = last.min(window.first as usize);
        let mut all = Words::EMPTY;
        for _ in 0..reads {
            // SAFETY: `start` is at most `last` and a place less than the stride; the bytes
            // reach a word further, as was asserted of the extent.
            let word = unsafe { bytes.get_unchecked(start + place..start + place + READ) };
            all = all | Words::read(self::bytes(word));
            start = last.min(start + layout.row);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a window of a large layout in the rows of a small one.
    fn read_beyond(window: impl FnOnce(&mut RowLayout) -> Window) {
        let [mut small, mut large] = [RowLayout::default(), RowLayout::default()];
        small.start(8);
        large.start(720);
        let (mut extent, mut rows) = (Extent::default(), QuadRows::default());
        extent.take(&window(&mut large));
        rows.fit(&small);
        let _ = Windows::new((&small, &rows, 0), &extent);
    }

    #[test]
    #[should_panic(expected = "extent")]
    fn windows_beyond_the_rows_are_refused() {
        read_beyond(|large| large.nothing());
    }

    #[test]
    #[should_panic(expected = "extent")]
    fn bearings_beyond_a_turn_are_refused() {
        read_beyond(|large| large.window(0..1, 1));
    }
}
