//! Which ranges the cells of a block see in each direction, as sets.
//!
//! For each block of 16 × 16 cells and each bin of distances, one bit a
//! direction says whether any open cell of the block sees an obstacle at such a
//! distance in that direction. A beam can only vote in a block at headings
//! whose bit is set for a bin that its taper covers, and one row of bits
//! answers that for all headings at once.

use crate::directions::{Direction, Directions};
use crate::grid::Grid;
use crate::intervals::Intervals;
use crate::sweep::SweepGrid;

/// Cells along the side of a block.
pub(crate) const SIDE: usize = 16;

/// Width of the nearest bins in cells: a block smears distances by far more.
const NEAR_BIN_CELLS: f64 = 2.0;

/// Distance in cells at which bins are twice as wide as the nearest ones: the
/// tapers of far readings are wider, too.
const BIN_GROWTH_CELLS: f64 = 64.0;

/// Directions that are marked at a time: the bits of a byte.
const OCTET: usize = 8;

/// Bytes that are read from a row at a time.
pub(crate) const READ: usize = 64;

/// The visible ranges of all blocks.
#[derive(Debug, Clone)]
pub(crate) struct RangeSets {
    /// Bytes of a row: a bit for each direction, twice around.
    stride: usize,
    /// The rows of block `b` are `starts[b]..starts[b + 1]`, one for each bin.
    starts: Vec<u32>,
    rows: Vec<u8>,
}

/// Into which bin of distances the steps along a direction fall.
#[derive(Debug, Clone)]
pub(crate) struct Bins {
    /// Cells a step, by class of direction.
    cells_per_step: Vec<f64>,
}

impl Bins {
    pub(crate) fn new(directions: &Directions) -> Self {
        let classes = 0..directions.classes();
        Bins {
            cells_per_step: classes
                .map(|class| 1.0 / directions.steps_per_cell(class))
                .collect(),
        }
    }

    /// The bin of a range along a class of directions; never falls with it.
    pub(crate) fn bin(&self, class: usize, steps: u16) -> usize {
        let cells = f64::from(steps) * self.cells_per_step[class];
        (BIN_GROWTH_CELLS / NEAR_BIN_CELLS * (cells / BIN_GROWTH_CELLS).ln_1p()) as usize
    }
}

impl RangeSets {
    /// Collects the ranges of all open cells. `blocks` are the intervals of the
    /// same blocks, which say how far each of them sees.
    pub(crate) fn new(grid: &Grid, directions: &Directions, blocks: &Intervals) -> Self {
        let bins = Bins::new(directions);
        let stride = directions.count() / 4;
        let mut starts = vec![0];
        for block in 0..blocks.columns * blocks.rows {
            let (_, end) = blocks.block(block);
            let farthest = directions.all().iter().zip(end).map(|(direction, &end)| {
                if end == 0 {
                    0
                } else {
                    bins.bin(direction.class, end - 1) + 1
                }
            });
            starts.push(starts[block] + farthest.max().unwrap_or(0) as u32);
        }
        let rows = starts[blocks.columns * blocks.rows] as usize * stride + READ;
        let mut sets = RangeSets {
            stride,
            starts,
            rows: vec![0; rows],
        };
        let mut planes = Planes::new(grid);
        for (octet, directions) in directions.all().chunks(OCTET).enumerate() {
            planes.fill(directions, &bins);
            for block in 0..sets.blocks() {
                sets.mark(octet, block, blocks.columns, &planes);
            }
        }
        sets.repeat(directions.count());
        sets
    }

    /// Marks what a block sees in the eight directions of the planes.
    fn mark(&mut self, octet: usize, block: usize, columns: usize, planes: &Planes) {
        let bins = (self.starts[block + 1] - self.starts[block]) as usize;
        let seen = planes.mark(block % columns * SIDE, block / columns * SIDE);
        let rows = &mut self.rows[self.starts[block] as usize * self.stride..];
        for (row, &seen) in rows.chunks_exact_mut(self.stride).zip(&seen[..bins]) {
            row[octet] = seen;
        }
    }

    /// Repeats the bits of each row behind themselves.
    fn repeat(&mut self, directions: usize) {
        for row in self.rows.chunks_exact_mut(self.stride) {
            row.copy_within(0..directions / 8, directions / 8);
        }
    }

    /// How many blocks there are.
    pub(crate) fn blocks(&self) -> usize {
        self.starts.len() - 1
    }

    /// The rows of a block, from the nearest bin; behind the last row at least
    /// [`READ`] more bytes can be read.
    pub(crate) fn block(&self, block: usize) -> BlockSets<'_> {
        let first = self.starts[block] as usize;
        BlockSets {
            bins: self.starts[block + 1] as usize - first,
            stride: self.stride,
            rows: &self.rows[first * self.stride..],
        }
    }

    /// Bytes that the sets take.
    pub(crate) fn bytes(&self) -> usize {
        self.rows.len() + 4 * self.starts.len()
    }
}

/// Bins that a byte can name, with one for what sees nothing.
const BINS: usize = 256;

/// The bins that all cells see into, in eight directions.
struct Planes {
    sweeps: SweepGrid,
    width: usize,
    height: usize,
    /// Row by row, or column by column where the direction's major axis is x.
    bins: [Vec<u8>; OCTET],
    is_by_column: [bool; OCTET],
}

impl Planes {
    /// The bin of cells that see nothing or that nobody can stand in. The
    /// longest range, 46340 cells, lies in bin 210.
    const NOTHING: u8 = (BINS - 1) as u8;

    fn new(grid: &Grid) -> Self {
        Planes {
            sweeps: SweepGrid::new(grid),
            width: grid.width(),
            height: grid.height(),
            bins: std::array::from_fn(|_| vec![0; grid.cells().len()]),
            is_by_column: [false; OCTET],
        }
    }

    fn fill(&mut self, directions: &[Direction], bins: &Bins) {
        let longest = self.width.max(self.height) as u16;
        for ((direction, plane), is_by_column) in directions
            .iter()
            .zip(&mut self.bins)
            .zip(&mut self.is_by_column)
        {
            // No open cell has range 0, and none is farther than a side.
            let mut table: Vec<u8> = (0..=longest)
                .map(|steps| bins.bin(direction.class, steps) as u8)
                .collect();
            table[0] = Self::NOTHING;
            *is_by_column = direction.x_major;
            let minor = if direction.x_major {
                self.height
            } else {
                self.width
            };
            self.sweeps.sweep(direction, |row| {
                let plane = &mut plane[row.major * minor..][..minor];
                for (bin, &range) in plane.iter_mut().zip(row.ranges) {
                    *bin = table
                        .get(usize::from(range))
                        .copied()
                        .unwrap_or(Self::NOTHING);
                }
            });
        }
    }

    /// By bin, a byte whose bit `i` says whether a cell of the block at
    /// (`left`, `bottom`) sees into the bin in direction `i`.
    fn mark(&self, left: usize, bottom: usize) -> [u8; BINS] {
        let mut seen = [0u8; BINS];
        let (right, top) = (self.width.min(left + SIDE), self.height.min(bottom + SIDE));
        for ((bit, plane), &is_by_column) in (0..).zip(&self.bins).zip(&self.is_by_column) {
            let (majors, minors, stride) = if is_by_column {
                (left..right, bottom..top, self.height)
            } else {
                (bottom..top, left..right, self.width)
            };
            for major in majors {
                for &bin in &plane[major * stride..][minors.clone()] {
                    seen[usize::from(bin)] |= 1 << bit;
                }
            }
        }
        seen
    }
}

/// The visible ranges of one block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlockSets<'a> {
    /// Bins that any cell sees into.
    pub bins: usize,
    stride: usize,
    rows: &'a [u8],
}

impl BlockSets<'_> {
    /// Bits of a bin from direction `8 · byte` on.
    #[inline(always)]
    pub(crate) fn read(&self, bin: usize, byte: usize) -> [u64; READ / 8] {
        let start = bin * self.stride + byte;
        let bytes = &self.rows[start..start + READ];
        std::array::from_fn(|i| {
            let word: [u8; 8] = std::array::from_fn(|j| bytes[8 * i + j]);
            u64::from_le_bytes(word)
        })
    }
}
