//! Ranges of the cells of a strip: a row of blocks across the major axis of a
//! bundle of lines.
//!
//! A row of cells is stored as four planes: plane `k` holds every fourth cell from the
//! `k`-th on, one for each block. So the numbers pooled over a block are in the same lane
//! of 16 vectors.

use super::SIDE;
use crate::directions::swap_unless;
use crate::grid::{Cell, Grid};
use crate::program::NO_RANGE;

/// Numbers in a cache line.
const LINE: usize = 32;

/// A cache line of numbers, so that rows made of them are aligned for vectors.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
struct CacheLine([u16; LINE]);

/// Numbers of a row of cells, with a margin of [`NO_RANGE`] around each plane.
#[derive(Debug, Clone)]
pub(super) struct Row {
    /// Blocks along the row, rounded up to whole cache lines.
    lanes: usize,
    lines: Vec<CacheLine>,
}

/// Returns the start of a plane, counted from the start of a row with this many lanes.
#[inline(always)]
fn start(lanes: usize, plane: usize) -> usize {
    LINE + plane * (lanes + LINE)
}

impl Row {
    /// Returns a row of cells that see nothing, of this many blocks.
    pub(super) fn new(blocks: usize) -> Self {
        let lanes = blocks.next_multiple_of(LINE);
        Row {
            lanes,
            lines: vec![CacheLine([NO_RANGE; LINE]); start(lanes, SIDE) / LINE],
        }
    }

    #[inline(always)]
    pub(super) fn plane(&self, plane: usize) -> &[u16] {
        self.lanes_from(start(self.lanes, plane))
    }

    #[inline(always)]
    fn plane_mut(&mut self, plane: usize) -> &mut [u16] {
        let (start, lanes) = (start(self.lanes, plane), self.lanes);
        &mut bytemuck::cast_slice_mut(&mut self.lines)[start..][..lanes]
    }

    /// Returns the neighbours of a plane's cells, `shift` cells on along the row: -1 to 1.
    #[inline(always)]
    fn beside(&self, plane: usize, shift: i64) -> &[u16] {
        let start = |plane| start(self.lanes, plane);
        self.lanes_from(match (plane, shift) {
            (0, -1) => start(SIDE - 1) - 1,
            (_, -1) => start(plane - 1),
            (plane, 1) if plane == SIDE - 1 => start(0) + 1,
            (_, 1) => start(plane + 1),
            _ => start(plane),
        })
    }

    #[inline(always)]
    fn lanes_from(&self, start: usize) -> &[u16] {
        &bytemuck::cast_slice(&self.lines)[start..][..self.lanes]
    }
}

/// The cells of one strip as masks for rays.
#[derive(Debug, Clone)]
pub(super) struct StripMasks {
    /// 0 where the cell is occupied, else all ones.
    pass: [Row; SIDE],
    /// All ones where the cell blocks rays without a hit or is off the map, else 0.
    lose: [Row; SIDE],
}

impl StripMasks {
    pub(super) fn new(blocks: usize) -> Self {
        let rows = || std::array::from_fn(|_| Row::new(blocks));
        StripMasks {
            pass: rows(),
            lose: rows(),
        }
    }

    /// Takes the cells of a strip: a column of blocks if `x_major`, else a row of them.
    pub(super) fn fill(&mut self, grid: &Grid, x_major: bool, strip: usize) {
        let (majors, minors) = swap_unless(x_major, (grid.width(), grid.height()));
        let (major_stride, minor_stride) = swap_unless(x_major, (1, grid.width()));
        for (row, (pass, lose)) in self.pass.iter_mut().zip(&mut self.lose).enumerate() {
            let major = SIDE * strip + row;
            for plane in 0..SIDE {
                let (pass, lose) = (pass.plane_mut(plane), lose.plane_mut(plane));
                let cells = if major < majors {
                    minors.saturating_sub(plane).div_ceil(SIDE)
                } else {
                    0
                };
                lose[cells..].fill(u16::MAX);
                let cells = grid
                    .cells()
                    .get(major * major_stride + plane * minor_stride..)
                    .unwrap_or(&[])
                    .iter()
                    .step_by(SIDE * minor_stride)
                    .take(cells);
                for ((&cell, pass), lose) in cells.zip(pass).zip(lose) {
                    *pass = if cell == Cell::Occupied { 0 } else { u16::MAX };
                    *lose = if cell == Cell::Blocked { u16::MAX } else { 0 };
                }
            }
        }
    }

    /// Finds the ranges of the cells of the strip's row `row`: 0 if the cell is occupied,
    /// [`NO_RANGE`] if it blocks rays without a hit, else one step more than the range of its
    /// next cell, which is `shift` cells on in the row `next`.
    #[inline(always)]
    pub(super) fn sweep(&self, row: usize, shift: i64, next: &Row, ranges: &mut Row) {
        for plane in 0..SIDE {
            let next = next.beside(plane, shift);
            let masks = self.pass[row]
                .plane(plane)
                .iter()
                .zip(self.lose[row].plane(plane));
            let ranges = ranges.plane_mut(plane).iter_mut();
            for ((range, &next), (&pass, &lose)) in ranges.zip(next).zip(masks) {
                *range = next.saturating_add(1) & pass | lose;
            }
        }
    }
}
