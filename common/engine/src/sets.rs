//! Which ranges the cells of a block see in each direction, as sets.
//!
//! For each block of cells and each bin of distances, one bit a direction says
//! whether any open cell of the block sees an obstacle at such a distance in
//! that direction. A beam can only vote in a block at headings whose bit is set
//! for a bin that its taper covers, and one row of bits answers that for all
//! headings at once.

use crate::directions::{Direction, Directions};
use crate::grid::{Cell, Grid};
use crate::sweep::SweepGrid;

/// Width of the nearest bins in cells: a block smears distances by far more.
const NEAR_BIN_CELLS: f64 = 2.0;

/// Distance in cells at which bins are twice as wide as the nearest ones: the
/// tapers of far readings are wider, too.
const BIN_GROWTH_CELLS: f64 = 64.0;

/// Directions that are marked at a time: the bits of a byte.
const OCTET: usize = 8;

/// Bytes that are read from a row at a time.
pub(crate) const READ: usize = 64;

/// The visible ranges of all blocks of one size.
#[derive(Debug, Clone)]
pub(crate) struct RangeSets {
    /// Cells along the side of a block.
    pub side: usize,
    /// Blocks along x.
    pub columns: usize,
    /// Blocks along y.
    pub rows: usize,
    /// Bytes of a row of bits: one bit for each direction.
    stride: usize,
    /// The bins of block `b` are `starts[b]..starts[b + 1]`.
    starts: Vec<u32>,
    bits: Vec<u8>,
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
    /// Collects the ranges of all open cells in blocks of `side` cells.
    pub(crate) fn new(grid: &Grid, side: usize, directions: &Directions) -> Self {
        let bins = Bins::new(directions);
        let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
        let stride = directions.count() / 8;
        let starts = starts_of(grid, side, &bins, directions);
        let bits = vec![0; starts[columns * rows] as usize * stride];
        let mut sets = RangeSets {
            side,
            columns,
            rows,
            stride,
            starts,
            bits,
        };
        let mut planes = Planes::new(grid);
        for (octet, directions) in directions.all().chunks(OCTET).enumerate() {
            planes.fill(directions, &bins);
            for block in 0..columns * rows {
                let seen = planes.mark(block % columns * side, block / columns * side, side);
                let bits = sets.block_mut(block);
                let bins = bits.len() / stride;
                bits[octet * bins..(octet + 1) * bins].copy_from_slice(&seen[..bins]);
            }
        }
        sets.settle();
        sets
    }

    /// Those of blocks that join two by two of these.
    pub(crate) fn joined(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let finer = |block: usize| {
            let (x, y) = (2 * (block % columns), 2 * (block / columns));
            let all = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let on_map = all
                .into_iter()
                .filter(|&(x, y)| x < self.columns && y < self.rows);
            on_map.map(|(x, y)| y * self.columns + x)
        };
        let mut starts = vec![0];
        for block in 0..columns * rows {
            let bins = finer(block)
                .map(|finer| self.starts[finer + 1] - self.starts[finer])
                .max();
            starts.push(starts[block] + bins.unwrap_or(0));
        }
        let bits = vec![0; starts[columns * rows] as usize * self.stride];
        let mut sets = RangeSets {
            side: 2 * self.side,
            columns,
            rows,
            stride: self.stride,
            starts,
            bits,
        };
        for block in 0..columns * rows {
            for finer in finer(block) {
                for (joined, bits) in sets.block_mut(block).iter_mut().zip(self.block(finer)) {
                    *joined |= bits;
                }
            }
        }
        sets
    }

    /// How many blocks there are.
    pub(crate) fn blocks(&self) -> usize {
        self.columns * self.rows
    }

    /// Bytes that the sets take.
    pub(crate) fn bytes(&self) -> usize {
        self.bits.len() + 4 * self.starts.len()
    }

    /// The rows of bits of a block, from the nearest bin.
    fn block(&self, block: usize) -> &[u8] {
        &self.bits[self.starts[block] as usize * self.stride
            ..self.starts[block + 1] as usize * self.stride]
    }

    fn block_mut(&mut self, block: usize) -> &mut [u8] {
        &mut self.bits[self.starts[block] as usize * self.stride
            ..self.starts[block + 1] as usize * self.stride]
    }

    /// Turns each block, filled octet by octet, into a row of bits for each bin,
    /// and gives up the bins from the far end that no cell sees into.
    fn settle(&mut self) {
        let mut kept = 0;
        let mut rows = Vec::new();
        for block in 0..self.blocks() {
            let octets = self.block(block);
            let bins = octets.len() / self.stride;
            let seen = octets
                .chunks_exact(bins)
                .filter_map(|octet| octet.iter().rposition(|&bits| bits != 0));
            let seen = seen.max().map_or(0, |last| last + 1);
            rows.clear();
            rows.extend((0..seen).flat_map(|bin| octets.iter().skip(bin).step_by(bins)));
            self.bits[kept * self.stride..][..rows.len()].copy_from_slice(&rows);
            self.starts[block] = kept as u32;
            kept += seen;
        }
        let blocks = self.blocks();
        self.starts[blocks] = kept as u32;
        self.bits.truncate(kept * self.stride);
        self.bits.shrink_to_fit();
    }
}

/// Where the bins of each block start, if each sees as far as the farthest
/// obstacle could lie.
fn starts_of(grid: &Grid, side: usize, bins: &Bins, directions: &Directions) -> Vec<u32> {
    let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
    let occupied = |i: &usize| grid.cells()[*i] == Cell::Occupied;
    let all = || (0..grid.cells().len()).filter(occupied);
    let span = |of: &dyn Fn(usize) -> usize| {
        (
            all().map(of).min().unwrap_or(0),
            all().map(of).max().unwrap_or(0),
        )
    };
    let (left, right) = span(&|i| i % grid.width());
    let (bottom, top) = span(&|i| i / grid.width());
    let mut starts = vec![0];
    for block in 0..columns * rows {
        // A ray has as many steps as it crosses columns or rows.
        let across = |at: usize, low: usize, high: usize| {
            (at + side).saturating_sub(low).max(high.saturating_sub(at))
        };
        let x = across(block % columns * side, left, right);
        let y = across(block / columns * side, bottom, top);
        let farthest = (0..directions.classes()).map(|class| bins.bin(class, x.max(y) as u16));
        starts.push(starts[block] + farthest.max().unwrap_or(0) as u32 + 1);
    }
    starts
}

/// The rows of one block, each twice in a row: bits can be read from any
/// direction on for a whole turn.
#[derive(Debug, Clone)]
pub(crate) struct BlockSets {
    bins: usize,
    stride: usize,
    bits: Vec<u8>,
}

impl BlockSets {
    pub(crate) fn new() -> Self {
        BlockSets {
            bins: 0,
            stride: 0,
            bits: Vec::new(),
        }
    }

    /// Takes the rows of a block.
    pub(crate) fn set(&mut self, sets: &RangeSets, block: usize) {
        let rows = sets.block(block);
        self.bins = rows.len() / sets.stride;
        self.stride = 2 * sets.stride;
        self.bits.clear();
        for row in rows.chunks_exact(sets.stride) {
            self.bits.extend_from_slice(row);
            self.bits.extend_from_slice(row);
        }
        // Behind the last row, as much can be read as from it.
        self.bits.extend_from_slice(&[0; READ]);
    }

    /// Bins that any cell sees into.
    #[inline(always)]
    pub(crate) fn bins(&self) -> usize {
        self.bins
    }

    /// Bits of a bin from direction `8 · byte` on.
    #[inline(always)]
    pub(crate) fn read(&self, bin: usize, byte: usize) -> [u64; READ / 8] {
        let start = bin * self.stride + byte;
        let bytes = &self.bits[start..start + READ];
        std::array::from_fn(|i| {
            let word: [u8; 8] = std::array::from_fn(|j| bytes[8 * i + j]);
            u64::from_le_bytes(word)
        })
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
    /// (`left`, `bottom`), `side` cells wide, sees into the bin in direction `i`.
    fn mark(&self, left: usize, bottom: usize, side: usize) -> [u8; BINS] {
        let mut seen = [0u8; BINS];
        let (right, top) = (self.width.min(left + side), self.height.min(bottom + side));
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
