//! Which ranges the cells of a block see in each direction, as sets.
//!
//! For each block of 16 × 16 cells and each bin of distances, one bit a
//! direction says whether any open cell of the block sees an obstacle at such a
//! distance in that direction. A beam can only vote in a block at headings
//! whose bit is set for a bin that its taper covers, and one row of bits
//! answers that for all headings at once.

use crate::directions::{Direction, Directions};
use crate::grid::{Cell, Grid};
use crate::intervals::Intervals;
use crate::lines::NO_RANGE;
use crate::sweep::SweepGrid;

/// Cells along the side of a block.
pub(crate) const SIDE: usize = 16;

/// Cells of distance in a bin: a block smears distances by far more.
const CELLS_PER_BIN: f64 = 2.0;

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
    /// By class of direction.
    bins_per_step: Vec<f64>,
}

impl Bins {
    pub(crate) fn new(directions: &Directions) -> Self {
        let classes = 0..directions.classes();
        let bins_per_step =
            classes.map(|class| 1.0 / (directions.steps_per_cell(class) * CELLS_PER_BIN));
        Bins {
            bins_per_step: bins_per_step.collect(),
        }
    }

    /// The bin of a range along a class of directions; never falls with it.
    pub(crate) fn bin(&self, class: usize, steps: u16) -> usize {
        (f64::from(steps) * self.bins_per_step[class]) as usize
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
        let sweeps = SweepGrid::new(grid);
        for (d, direction) in directions.all().iter().enumerate() {
            sets.mark(grid, &sweeps, direction, d, blocks.columns, &bins);
        }
        sets.repeat(directions.count());
        sets
    }

    /// Marks the ranges along one direction.
    fn mark(
        &mut self,
        grid: &Grid,
        sweeps: &SweepGrid,
        direction: &Direction,
        d: usize,
        columns: usize,
        bins: &Bins,
    ) {
        let (byte, bit) = (d / 8, 1 << (d % 8));
        let longest = grid.width().max(grid.height()) as u16;
        let offsets: Vec<u32> = (0..=longest)
            .map(|steps| (bins.bin(direction.class, steps) * self.stride + byte) as u32)
            .collect();
        sweeps.sweep(direction, |row| {
            for (minor, &range) in row.ranges.iter().enumerate() {
                if range == NO_RANGE || range == 0 {
                    continue;
                }
                let (x, y) = if direction.x_major {
                    (row.major, minor)
                } else {
                    (minor, row.major)
                };
                let block = y / SIDE * columns + x / SIDE;
                let row = self.starts[block] as usize * self.stride;
                self.rows[row + offsets[usize::from(range)] as usize] |= bit;
            }
        });
        debug_assert!(
            grid.cells().contains(&Cell::Occupied) || self.rows.iter().all(|&byte| byte == 0)
        );
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
