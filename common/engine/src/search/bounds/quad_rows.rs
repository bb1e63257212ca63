//! The sets of a quad of blocks, laid out so that windows of bins are read quickly.
//!
//! Each row holds a full turn and one word more: a word can be read from any direction
//! on. Beside each row lies the same joined with the next one, so that a window takes
//! half as many reads.

use std::ops::Range;

use crate::search::index::bins::Bins;
use crate::search::index::bits::CHUNK;
use crate::search::index::intervals::ROW_SHIFT;
use crate::search::index::sets::{Byte, READ, SetRows};
use crate::simd::words::{BYTES, BitWords, QUAD};

/// Where rows lie.
#[derive(Debug, Clone, Default)]
pub(crate) struct RowLayout {
    /// Bytes of a turn.
    stride: usize,
    /// Bytes from a row to where the same starts that is joined with the next one, and
    /// from there to the next row.
    row: usize,
    /// How many rows there are at most. Behind them is nothing.
    most: usize,
    /// Rows that are read at all.
    needed: Range<usize>,
    /// A bit for each row that is read alone, and for each that is read with the next one.
    alone: u64,
    joined: u64,
    /// Where a byte of two turns lies.
    turns: Vec<u32>,
}

/// Some rows at a beam's bearing, but for what it leaves by eight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    /// Where the first of them starts that is read, and the last.
    first: u32,
    last: u32,
    /// The whole bytes of the bearing.
    byte: u32,
    /// How often is read.
    pub reads: u32,
}

/// The rows of a quad.
#[derive(Debug, Clone, Default)]
pub(crate) struct QuadRows {
    bytes: Vec<Byte>,
    /// The rows that have any bits.
    used: Range<usize>,
}

/// How far windows go.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Extent {
    /// The end of their bytes, and where the farthest of their rows starts.
    bytes: usize,
    rows: usize,
}

/// The rows of a quad, in which windows are read that were found to lie in them.
#[derive(Clone, Copy)]
pub(crate) struct Windows<'a> {
    reader: Reader<'a>,
}

/// The rows of a quad, to be read at the headings of a chunk.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    layout: &'a RowLayout,
    bytes: &'a [Byte],
    /// The first byte of the chunk.
    start: usize,
}

impl RowLayout {
    /// Starts again, with nothing that is read.
    pub(crate) fn start(&mut self, directions: usize) {
        self.stride = directions / 8;
        let turns = (READ - 1).div_ceil(self.stride);
        self.row = (turns * self.stride + READ).next_multiple_of(READ);
        self.most = (usize::from(Bins::NOTHING) >> ROW_SHIFT) + 1;
        self.needed = self.most..0;
        (self.alone, self.joined) = (0, 0);
        let turn = 0..self.stride as u32;
        self.turns.clear();
        self.turns.extend(turn.clone().chain(turn));
    }

    /// A window of rows from direction `8 · byte` on.
    pub(crate) fn window(&mut self, rows: Range<usize>, byte: usize) -> Window {
        assert!(
            byte < self.stride && rows.end <= self.most,
            "it lies within the rows"
        );
        let needed = &self.needed;
        self.needed = needed.start.min(rows.start)..needed.end.max(rows.end);
        // Two rows at a time, the last two with the one before if need be.
        let last = rows.end.saturating_sub(2).max(rows.start);
        let starts = rows.clone().step_by(2).map(|row| row.min(last));
        let is_joined = rows.len() > 1;
        let read = if is_joined {
            &mut self.joined
        } else {
            &mut self.alone
        };
        *read |= starts.fold(0, |read, row| read | 1 << row);
        let place = |row: usize| 2 * row + usize::from(is_joined);
        let (first, last) = (place(rows.start), place(last));
        Window {
            first: (first * self.row) as u32,
            last: (last * self.row) as u32,
            byte: byte as u32,
            reads: rows.len().div_ceil(2) as u32,
        }
    }

    /// A window that sees nothing.
    pub(crate) fn nothing(&self) -> Window {
        let start = (2 * self.most * self.row) as u32;
        Window {
            first: start,
            last: start,
            byte: 0,
            reads: 1,
        }
    }

    /// Where the rows end, with one of which nothing is seen.
    fn end(&self) -> usize {
        (2 * self.most + 1) * self.row
    }
}

impl QuadRows {
    /// Allocates buffers for a layout; nothing is left of what another one had.
    pub(crate) fn fit(&mut self, layout: &RowLayout) {
        self.bytes.clear();
        self.bytes.resize(layout.end(), [0; QUAD]);
        self.used = 0..0;
    }

    /// Takes the rows of a quad.
    #[inline(always)]
    pub(crate) fn take<W: BitWords>(
        &mut self,
        set: W::Set,
        layout: &RowLayout,
        rows: &SetRows<'_>,
    ) {
        let (row, stride) = (layout.row, layout.stride);
        // The row before the first one is joined with it.
        let first = rows.rows.start.saturating_sub(1).max(layout.needed.start);
        let taken = first..rows.rows.end.min(layout.needed.end);
        let mut kept = rows.kept_before(taken.start);
        for i in taken.clone() {
            let (earlier, own) = self.bytes.split_at_mut(2 * i * row);
            let own = &mut own[..row];
            if !rows.rows.contains(&i) {
                own.fill([0; QUAD]);
                continue;
            }
            let is_joined = i > taken.start && layout.joined >> (i - 1) & 1 == 1;
            let before = if is_joined {
                earlier.len() - 2 * row
            } else {
                earlier.len()
            };
            let (before, joined) = earlier[before..].split_at_mut(if is_joined { row } else { 0 });
            for (start, &mask) in (0..stride).step_by(READ).zip(rows.masks_of(i)) {
                let words = W::expand(set, mask, bytes(&rows.bytes[kept..]));
                words.write(bytes_mut(&mut own[start..]));
                if is_joined {
                    let both = W::read(set, bytes(&before[start..])).or(words);
                    both.write(bytes_mut(&mut joined[start..]));
                }
                kept += mask.count_ones() as usize;
            }
            if is_joined {
                go_round::<W>(set, joined, stride);
            }
        }
        if let Some(last) = taken.clone().next_back() {
            // Nothing is seen behind the last one, or nobody reads it.
            let rows = &mut self.bytes[2 * last * row..][..2 * row];
            let (last, joined) = rows.split_at_mut(row);
            joined.copy_from_slice(last);
            go_round::<W>(set, joined, stride);
        }
        for i in taken.clone().filter(|&i| layout.alone >> i & 1 == 1) {
            go_round::<W>(set, &mut self.bytes[2 * i * row..][..row], stride);
        }
        for used in self.used.clone() {
            if !taken.contains(&used) {
                self.bytes[2 * used * row..][..2 * row].fill([0; QUAD]);
            }
        }
        self.used = taken;
    }
}

/// Lets words be read from any byte of a row's first turn on.
#[inline(always)]
fn go_round<W: BitWords>(set: W::Set, row: &mut [Byte], stride: usize) {
    let turn = W::read(set, bytes(row));
    // What is copied too much, the next turn overwrites.
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

impl<'a> Reader<'a> {
    #[inline(always)]
    pub(crate) fn new(layout: &'a RowLayout, rows: &'a QuadRows, chunk: usize) -> Self {
        let start = chunk * (CHUNK / 8);
        let end = layout.end();
        assert!(start < layout.stride && rows.bytes.len() >= end);
        Reader {
            layout,
            bytes: &rows.bytes[..end],
            start,
        }
    }

    /// A reader of windows, none of which goes further than `extent`.
    ///
    /// # Panics
    /// If the rows do not go so far.
    #[inline(always)]
    pub(crate) fn within(self, extent: &Extent) -> Windows<'a> {
        let stride = self.layout.stride;
        assert!(extent.bytes <= stride && extent.rows + stride + READ <= self.bytes.len());
        Windows { reader: self }
    }
}

impl Extent {
    /// Takes a window in.
    pub(crate) fn take(&mut self, window: &Window) {
        self.bytes = self.bytes.max(window.byte as usize + 1);
        self.rows = self.rows.max(window.last as usize);
    }
}

impl Windows<'_> {
    /// The bits of a window that is read so often, in the order of sets, see
    /// [`BitWords::sorted`]. Reading oftener than needed changes nothing.
    ///
    /// # Safety
    /// The extent within which windows are read must have taken this one in.
    #[inline(always)]
    pub(crate) unsafe fn read<W: BitWords>(&self, set: W::Set, window: &Window, reads: u32) -> W {
        let Reader {
            layout,
            bytes,
            start: chunk,
        } = self.reader;
        // SAFETY: a window's byte and the start of a chunk are less than a turn each, as
        // was asserted of the extent and of the chunk.
        let place = unsafe { *layout.turns.get_unchecked(chunk + window.byte as usize) } as usize;
        let last = window.last as usize;
        let mut start = last.min(window.first as usize);
        let mut all = W::empty(set);
        for i in 0..reads {
            // SAFETY: `start` is at most `last` and a place less than the stride; the bytes
            // reach a word further, as was asserted of the extent.
            let word = unsafe { bytes.get_unchecked(start + place..start + place + READ) };
            let words = W::read(set, self::bytes(word));
            all = if i == 0 { words } else { all.or(words) };
            start = last.min(start + 4 * layout.row);
        }
        all
    }
}

#[cfg(test)]
mod tests;
