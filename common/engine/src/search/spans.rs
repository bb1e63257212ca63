//! The sets of one block, laid out so that windows of bins are read quickly.
//!
//! Each row goes round twice: bits can be read from any direction on. A narrow
//! window reads its rows one by one. For wide windows, rows are joined over
//! spans of 4, 8, 16, … rows, so that any of them is two spans that overlap.

use std::ops::Range;

use super::bins::Bins;
use super::rows::{BitRow, Several};
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

/// The rows of some blocks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spans {
    /// Block by block.
    bits: Vec<u8>,
    /// Bytes of a block.
    size: usize,
    /// How many rows each has.
    used: Vec<usize>,
}

/// The rows of some blocks from a direction on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpansFrom<'a> {
    bits: &'a [u8],
    size: usize,
}

/// Where the bits of a window are read, in bytes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    starts: [u32; Window::MOST],
    reads: usize,
}

/// Windows of so many reads each, those with fewer reading twice.
#[derive(Debug, Clone, Default)]
pub(crate) struct Windows<const READS: usize> {
    starts: Vec<[u32; READS]>,
    /// No window reads beyond this byte.
    end: usize,
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
        if rows.len() <= Window::MOST {
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
    /// Makes room for a layout and so many blocks; nothing is left of what another
    /// one had.
    pub(crate) fn fit(&mut self, layout: &SpanLayout, blocks: usize) {
        // Spans of rows near the end reach beyond them.
        let rows = (1 + layout.spans.len()) * layout.rows + (LEAST_SPAN << layout.spans.len());
        self.size = rows * layout.row;
        self.bits.clear();
        self.bits.resize(blocks * self.size, 0);
        self.used.clear();
        self.used.resize(blocks, 0);
    }

    /// Takes the rows of a block as those of number `place`.
    #[inline(always)]
    pub(crate) fn set<R: BitRow>(
        &mut self,
        layout: &SpanLayout,
        place: usize,
        block: BlockRows<'_>,
    ) {
        let (row, stride) = (layout.row, layout.stride);
        let bits = &mut self.bits[place * self.size..][..self.size];
        let count = block.count.min(layout.needed);
        let pieces = stride.div_ceil(READ);
        for (i, to) in bits.chunks_exact_mut(row).take(count).enumerate() {
            let from = &block.bytes[i * stride..][..pieces * READ];
            // What is copied too much, the second turn overwrites.
            for turn in [0, stride] {
                let to = &mut to[turn..][..pieces * READ];
                let (from, _) = from.as_chunks::<READ>();
                for (to, from) in to.chunks_exact_mut(READ).zip(from) {
                    R::read(from).write(to);
                }
            }
        }
        let used = std::mem::replace(&mut self.used[place], count);
        if used > count {
            bits[count * row..used * row].fill(0);
        }
        for (width, rows) in layout.spans.iter().enumerate() {
            join::<R>(bits, layout, width, rows.clone());
        }
    }

    /// The bits from those of direction `8 · byte` on.
    #[inline(always)]
    pub(crate) fn from(&self, byte: usize) -> SpansFrom<'_> {
        SpansFrom {
            bits: &self.bits[byte..],
            size: self.size,
        }
    }
}

/// Makes spans of a width, of rows or of spans half as wide.
#[inline(always)]
fn join<R: BitRow>(bits: &mut [u8], layout: &SpanLayout, width: usize, rows: Range<usize>) {
    let row = layout.row;
    let (narrower, wide) = bits.split_at_mut((1 + width) * layout.rows * row);
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

impl Window {
    /// Most reads of any window.
    pub(crate) const MOST: usize = 6;

    /// How many there are.
    pub(crate) fn reads(&self) -> usize {
        self.reads
    }
}

impl<const READS: usize> Windows<READS> {
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// Lets go of all; their room stays.
    pub(crate) fn clear(&mut self) {
        self.starts.clear();
        self.end = 0;
    }

    pub(crate) fn push(&mut self, window: Window) {
        let starts = std::array::from_fn(|read| window.starts[read]);
        let last = starts.iter().max().map_or(0, |&start| start as usize);
        self.starts.push(starts);
        self.end = self.end.max(last + READ);
    }

    /// To read the bits of each window in the first blocks.
    #[inline(always)]
    pub(crate) fn reader<'a, const N: usize>(
        &'a self,
        spans: SpansFrom<'a>,
    ) -> Reader<'a, READS, N> {
        let end = (N - 1) * spans.size + self.end;
        assert!(end <= spans.bits.len(), "windows end within the spans");
        Reader {
            starts: &self.starts,
            spans,
        }
    }
}

/// Windows, and what is read of them: no window of the last of `N` blocks ends behind
/// the spans.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a, const READS: usize, const N: usize> {
    starts: &'a [[u32; READS]],
    spans: SpansFrom<'a>,
}

impl<const READS: usize, const N: usize> Reader<'_, READS, N> {
    /// How many windows there are.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// The bits of window `i`.
    #[inline(always)]
    pub(crate) fn read<R: BitRow>(&self, i: usize) -> Several<R, N> {
        let mut all = Several::empty();
        for (read, &start) in self.starts[i].iter().enumerate() {
            let mut rows = Several::empty();
            for (block, row) in rows.0.iter_mut().enumerate() {
                let start = block * self.spans.size + start as usize;
                // SAFETY: no window reads beyond the spans, as was checked for the
                // reader.
                *row = R::read(unsafe { &*self.spans.bits.as_ptr().add(start).cast() });
            }
            all = if read == 0 { rows } else { all.or(rows) };
        }
        all
    }
}
