//! The sets of one block, laid out so that windows of bins are read quickly.
//!
//! Each row goes round twice: bits can be read from any direction on. A narrow
//! window reads its rows one by one. For wide windows, rows are joined over
//! spans of 4, 8, 16, … rows, so that any of them is two spans that overlap.

use std::ops::Range;

use super::bins::Bins;
use super::rows::BitRow;
use super::sets::BlockRows;

/// Bytes that are read from a row at a time.
pub(crate) const READ: usize = 64;

/// Rows of the narrowest span.
const LEAST_SPAN: usize = 4;

/// No spans yet: any others start before and end behind.
#[expect(clippy::reversed_empty_ranges, reason = "it is where growing starts")]
const NONE: Range<usize> = usize::MAX..0;

/// Where rows lie.
#[derive(Debug, Clone, Default)]
pub(crate) struct SpanLayout {
    /// Bytes of a row of sets.
    stride: usize,
    /// Bytes of a row of spans: that twice, and what is read beyond.
    row: usize,
    /// Rows for each width of spans.
    rows: usize,
    /// Rows of sets that are read at all.
    needed: usize,
    /// Which spans of 4, 8, 16, … rows are read, by their first rows.
    spans: Vec<Range<usize>>,
}

/// The rows of one block.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spans {
    bits: Vec<u8>,
    /// Rows of the last block.
    used: usize,
}

/// Where the bits of a window are read, some perhaps twice.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    starts: [u32; Window::WIDE],
    reads: usize,
}

impl SpanLayout {
    /// Starts anew, with nothing that is read.
    pub(crate) fn start(&mut self, directions: usize, shift: u32) {
        self.stride = directions / 8;
        self.row = (2 * self.stride + READ).next_multiple_of(READ);
        self.rows = (usize::from(Bins::NOTHING) >> shift) + 1;
        self.needed = 0;
        self.spans.clear();
    }

    /// Where to read a window of rows of sets, from direction `8 · byte` on.
    pub(crate) fn window(&mut self, rows: Range<usize>, byte: usize) -> Window {
        self.needed = self.needed.max(rows.end);
        if rows.len() <= Window::WIDE {
            return self.reading(rows.len(), byte, |read| rows.start + read);
        }
        let width = (rows.len() / LEAST_SPAN).ilog2() as usize;
        let second = rows.end - (LEAST_SPAN << width);
        self.need(width, rows.start..second + 1);
        let at = [rows.start, second].map(|row| (1 + width) * self.rows + row);
        self.reading(at.len(), byte, |read| at[read])
    }

    /// A window of so many reads, each of a row; there is at least one.
    fn reading(&self, reads: usize, byte: usize, row: impl Fn(usize) -> usize) -> Window {
        let start = |read: usize| (row(read.min(reads - 1)) * self.row + byte) as u32;
        Window {
            starts: std::array::from_fn(start),
            reads,
        }
    }

    /// Sees to it that spans of a width are made, and what they are made of.
    fn need(&mut self, width: usize, rows: Range<usize>) {
        if self.spans.len() <= width {
            self.spans.resize(width + 1, NONE);
        }
        let mut rows = rows;
        for width in (0..=width).rev() {
            let spans = &mut self.spans[width];
            *spans = spans.start.min(rows.start)..spans.end.max(rows.end);
            rows = spans.start..spans.end + (LEAST_SPAN << width) / 2;
        }
    }
}

impl Spans {
    /// Makes room for a layout; nothing is left of what another one had.
    pub(crate) fn fit(&mut self, layout: &SpanLayout) {
        // Spans of rows near the end reach beyond them.
        let rows = (1 + layout.spans.len()) * layout.rows + (LEAST_SPAN << layout.spans.len());
        self.bits.clear();
        self.bits.resize(rows * layout.row, 0);
        self.used = 0;
    }

    /// Takes the rows of a block.
    #[inline(always)]
    pub(crate) fn set<R: BitRow>(&mut self, layout: &SpanLayout, block: BlockRows<'_>) {
        let (row, stride) = (layout.row, layout.stride);
        let count = block.count.min(layout.needed);
        for (i, to) in self.bits.chunks_exact_mut(row).take(count).enumerate() {
            let from = &block.bytes[i * stride..];
            for turn in [0, stride] {
                // The second turn overwrites what the first one copied too much.
                for piece in (0..stride).step_by(READ) {
                    to[turn + piece..][..READ].copy_from_slice(&from[piece..][..READ]);
                }
            }
        }
        if self.used > count {
            self.bits[count * row..self.used * row].fill(0);
        }
        self.used = count;
        for (width, rows) in layout.spans.iter().enumerate() {
            self.join::<R>(layout, width, rows.clone());
        }
    }

    /// Makes spans of a width, of rows or of spans half as wide.
    #[inline(always)]
    fn join<R: BitRow>(&mut self, layout: &SpanLayout, width: usize, rows: Range<usize>) {
        let row = layout.row;
        let (narrower, wide) = self.bits.split_at_mut((1 + width) * layout.rows * row);
        let narrower = &narrower[width * layout.rows * row..];
        let (parts, step) = match width {
            0 => (LEAST_SPAN, 1),
            _ => (2, LEAST_SPAN << width >> 1),
        };
        for at in (rows.start * row..rows.end * row).step_by(READ) {
            let mut all = R::empty();
            for part in 0..parts {
                let bytes = narrower.get(at + part * step * row..);
                if let Some(bytes) = bytes.and_then(|bytes| bytes.first_chunk()) {
                    all = all.or(R::read(bytes));
                }
            }
            all.write(&mut wide[at..]);
        }
    }

    /// The bits from those of direction `8 · byte` on.
    #[inline(always)]
    pub(crate) fn from(&self, byte: usize) -> &[u8] {
        &self.bits[byte..]
    }
}

impl Window {
    /// Most reads of a narrow window.
    pub(crate) const NARROW: usize = 3;

    /// Most reads of any window.
    pub(crate) const WIDE: usize = 6;

    /// Whether [`Window::NARROW`] reads are enough.
    pub(crate) fn is_narrow(&self) -> bool {
        self.reads <= Self::NARROW
    }

    /// Bits of the window by its first `READS` reads.
    #[inline(always)]
    pub(crate) fn read<R: BitRow, const READS: usize>(&self, spans: &[u8]) -> R {
        let mut all = R::empty();
        for &start in &self.starts[..READS] {
            if let Some(bytes) = spans[start as usize..].first_chunk() {
                all = all.or(R::read(bytes));
            }
        }
        all
    }
}
