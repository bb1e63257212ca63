//! Counts votes at a known heading by line sweeps, at the same cost for any boundary.
//!
//! Along a line of a bundle the range of a cell follows from the next one's: 0 if the cell is
//! occupied, else one step more. All cells at one position of the major axis form a row, and the
//! next row is shifted by the same amount for all of them, so a whole row follows from the row
//! before at once. A sweep keeps the steps that are *left* until a beam's taper ends: `end` in an
//! obstacle, one less for each step away from it, 0 where the ray sees nothing. At the reading as many
//! are left as the taper's profile is long, so the votes are a look-up by the distance from that.

mod axis;
mod rows;

use std::ops::Range;

use axis::Axis;
use rows::Rows;

use crate::accumulator::{Accumulator, Query};
use crate::directions::{Direction, swap_unless};
use crate::grid::{Cell, Grid};
use crate::instruction_set::InstructionSet;
use crate::simd::{LANES, Simd, TABLE};

/// Side of the squares in which the sums along both axes are joined.
const SQUARE: usize = 8;

/// A grid prepared for sweeps that vote.
#[derive(Debug, Clone)]
pub struct FieldSweep {
    along_y: Plane,
    along_x: Plane,
}

/// Cells row by row over the major axis of some directions. Rows are filled up to a multiple of
/// [`LANES`] with cells that block rays.
#[derive(Debug, Clone)]
struct Plane {
    rows: usize,
    stride: usize,
    cells: Vec<Cell>,
}

/// Buffers of a sweep other than the field; kept from scan to scan, for any map, so that
/// they are allocated only once.
#[derive(Debug, Default)]
pub struct Workspace {
    beams: Vec<SweptBeam>,
    /// Votes by the distance from the reading, in steps, beam after beam.
    profiles: Vec<u8>,
    near: Rows<u8>,
    far: Rows<u16>,
    /// Votes of a batch in a row.
    votes: Vec<u8>,
    sums_along_y: Vec<u16>,
    sums_along_x: Vec<u16>,
}

/// A beam at a heading.
#[derive(Debug, Clone)]
struct SweptBeam {
    direction: Direction,
    /// Steps left in an obstacle: those from there to the taper's end.
    end: u16,
    /// Its part of the profiles.
    profile: Range<usize>,
}

impl SweptBeam {
    /// True if steps take 16 bits.
    fn is_far(&self) -> bool {
        self.end > 255
    }

    /// True if another beam passes the rows of cells in the same order.
    fn is_along(&self, other: &Self) -> bool {
        (self.direction.x_major, self.direction.step)
            == (other.direction.x_major, other.direction.step)
    }
}

impl FieldSweep {
    /// Prepares a grid.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        FieldSweep {
            along_y: Plane::new(grid, false),
            along_x: Plane::new(grid, true),
        }
    }

    /// Returns an accumulator on the grid with the best instruction set.
    pub fn accumulator(&self) -> Sweep<'_> {
        self.accumulator_with(InstructionSet::best())
    }

    /// Does the same with a given instruction set.
    ///
    /// # Panics
    /// If this processor does not have it.
    #[must_use]
    pub fn accumulator_with(&self, instruction_set: InstructionSet) -> Sweep<'_> {
        Sweep {
            sweeps: self,
            simd: Simd::new(instruction_set),
            workspace: Workspace::default(),
        }
    }

    /// Fills in the intensities of all cells like [`Accumulator::fill`], in a
    /// workspace that may have served another grid.
    pub(crate) fn fill(
        &self,
        simd: Simd,
        query: Query<'_>,
        workspace: &mut Workspace,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        workspace.take(query);
        for (plane, x_major) in [(&self.along_y, false), (&self.along_x, true)] {
            simd.run(Axis {
                plane,
                x_major,
                workspace,
                stop,
            })?;
        }
        let Workspace {
            sums_along_y,
            sums_along_x,
            ..
        } = workspace;
        field.resize(self.along_y.rows * self.along_x.rows, 0);
        self.merge(sums_along_y, sums_along_x, field);
        Some(())
    }

    /// Adds up the sums along both axes in open cells; those along x are transposed.
    fn merge(&self, along_y: &[u16], along_x: &[u16], field: &mut [u16]) {
        let (width, height) = (self.along_x.rows, self.along_y.rows);
        let (stride, column_stride) = (self.along_y.stride, self.along_x.stride);
        for bottom in (0..height).step_by(SQUARE) {
            for left in (0..width).step_by(SQUARE) {
                let mut columns = [[0; SQUARE]; SQUARE];
                for (x, column) in (left..width).zip(&mut columns) {
                    *column = *along_x[x * column_stride + bottom..]
                        .first_chunk()
                        .expect("a square");
                }
                for y in 0..SQUARE.min(height - bottom) {
                    let start = (bottom + y) * stride + left;
                    let row: &[u16; SQUARE] = along_y[start..].first_chunk().expect("a square");
                    let cells: &[Cell; SQUARE] =
                        self.along_y.cells[start..].first_chunk().expect("a square");
                    let mut sums = [0; SQUARE];
                    for i in 0..SQUARE {
                        let sum = row[i] + columns[i][y];
                        sums[i] = if cells[i] == Cell::Open { sum } else { 0 };
                    }
                    let to = &mut field[(bottom + y) * width + left..];
                    match to.first_chunk_mut() {
                        Some(to) if left + SQUARE <= width => *to = sums,
                        _ => to[..width - left].copy_from_slice(&sums[..width - left]),
                    }
                }
            }
        }
    }

    /// Size of the prepared grid in bytes.
    pub fn bytes(&self) -> usize {
        self.along_y.cells.len() + self.along_x.cells.len()
    }
}

/// Counts votes by one line sweep for each beam, at the same cost for any boundary.
#[derive(Debug)]
pub struct Sweep<'a> {
    sweeps: &'a FieldSweep,
    simd: Simd,
    workspace: Workspace,
}

impl Accumulator for Sweep<'_> {
    fn fill(
        &mut self,
        query: Query<'_>,
        field: &mut Vec<u16>,
        stop: &dyn Fn() -> bool,
    ) -> Option<()> {
        let workspace = &mut self.workspace;
        self.sweeps.fill(self.simd, query, workspace, field, stop)
    }
}

impl Plane {
    fn new(grid: &Grid, x_major: bool) -> Self {
        let (rows, columns) = swap_unless(x_major, (grid.width(), grid.height()));
        let stride = columns.next_multiple_of(LANES);
        let mut cells = vec![Cell::Blocked; rows * stride];
        for y in 0..grid.height() {
            for x in 0..grid.width() {
                let (row, column) = swap_unless(x_major, (x, y));
                cells[row * stride + column] = grid.cells()[y * grid.width() + x];
            }
        }
        Plane {
            rows,
            stride,
            cells,
        }
    }
}

impl Workspace {
    /// Takes the beams of a scan at a heading, those that are swept together side by side.
    fn take(&mut self, query: Query<'_>) {
        self.beams.clear();
        self.profiles.clear();
        for i in 0..query.program.beams() {
            let (direction, taper) = query.beam(i);
            let reach = taper.profile.len();
            if reach == 0 {
                continue;
            }
            let start = self.profiles.len();
            self.profiles.extend(taper.profile);
            // Where short profiles are looked up, a whole table is read.
            let end = self.profiles.len();
            self.profiles.resize(end.max(start + TABLE), 0);
            self.beams.push(SweptBeam {
                direction: *direction,
                end: taper.end(),
                profile: start..end,
            });
        }
        self.beams.sort_unstable_by_key(|beam| {
            (
                beam.direction.x_major,
                beam.direction.step,
                beam.is_far(),
                beam.profile.len(),
            )
        });
    }
}
