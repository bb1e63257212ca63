//! Range sweeps: the ranges of all cells along one direction, a row at a time.
//!
//! Along a line of a bundle the range of a cell follows from the next one's:
//! 0 if the cell is occupied, else one step more. All cells at one position of
//! the major axis form a row, and the next row lies shifted by the same amount
//! for all of them, so a row of ranges follows from the row before at once.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::program::NO_RANGE;
use crate::program::ScanProgram;
use crate::space::Space;
use crate::tables::VoteTables;

/// A grid laid out for sweeps along either axis.
#[derive(Debug, Clone)]
pub struct SweepGrid {
    along_y: Layout,
    along_x: Layout,
}

/// Masks of all cells, row by row over the major axis.
#[derive(Debug, Clone)]
struct Layout {
    minor: usize,
    /// 0 where the cell is occupied, else all ones.
    pass: Vec<u16>,
    /// All ones where rays are lost in the cell, else 0.
    lose: Vec<u16>,
}

/// The ranges of all cells at one position of the major axis.
#[derive(Debug, Clone, Copy)]
pub struct RangeRow<'a> {
    /// Position on the major axis.
    pub major: usize,
    /// Range of each cell in steps, [`NO_RANGE`] for none.
    pub ranges: &'a [u16],
}

impl SweepGrid {
    /// Lays out a grid.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let (width, height) = (grid.width(), grid.height());
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| y * width + x));
        let columns = (0..width).flat_map(|x| (0..height).map(move |y| y * width + x));
        SweepGrid {
            along_y: Layout::new(grid, width, rows),
            along_x: Layout::new(grid, height, columns),
        }
    }

    /// Sweeps towards the cells from which rays start, and shows each row of
    /// ranges. Rows lie along x where the direction's major axis is y, and
    /// along y where it is x.
    pub fn sweep(&self, direction: &Direction, mut show: impl FnMut(RangeRow<'_>)) {
        let layout = if direction.x_major {
            &self.along_x
        } else {
            &self.along_y
        };
        let rows = layout.pass.len() / layout.minor;
        // One cell of margin on either side: what lies off the map is no range.
        let mut next = vec![NO_RANGE; layout.minor + 2];
        let mut row = next.clone();
        for i in 0..rows {
            let major = if direction.step > 0 { rows - 1 - i } else { i };
            let shift =
                direction.minor(major as i64 + direction.step) - direction.minor(major as i64);
            let cells = major * layout.minor..(major + 1) * layout.minor;
            let ahead = &next[(1 + shift) as usize..][..layout.minor];
            let (pass, lose) = (&layout.pass[cells.clone()], &layout.lose[cells]);
            for (((range, &ahead), &pass), &lose) in
                row[1..].iter_mut().zip(ahead).zip(pass).zip(lose)
            {
                *range = (ahead.saturating_add(1) & pass) | lose;
            }
            show(RangeRow {
                major,
                ranges: &row[1..=layout.minor],
            });
            std::mem::swap(&mut row, &mut next);
        }
    }
}

impl Layout {
    fn new(grid: &Grid, minor: usize, order: impl Iterator<Item = usize>) -> Self {
        let cells: Vec<Cell> = order.map(|i| grid.cells()[i]).collect();
        Layout {
            minor,
            pass: cells
                .iter()
                .map(|&cell| if cell == Cell::Occupied { 0 } else { u16::MAX })
                .collect(),
            lose: cells
                .iter()
                .map(|&cell| if cell == Cell::Blocked { u16::MAX } else { 0 })
                .collect(),
        }
    }
}

/// Intensities of all cells at one heading, row by row from the lowest y: one
/// sweep for each beam, whatever the boundary; `None` if `stop` said so between
/// two of them.
#[must_use]
pub fn field(
    sweeps: &SweepGrid,
    grid: &Grid,
    program: &ScanProgram,
    space: &Space,
    heading: usize,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<u16>> {
    let (width, height) = (grid.width(), grid.height());
    let mut field = vec![0u16; width * height];
    let mut columns = field.clone();
    let tables = VoteTables::new(program, &space.directions);
    for beam in 0..program.beams() {
        if stop() {
            return None;
        }
        let direction = space.directions.get(heading + program.bearing(beam));
        let table = tables.get(beam, direction.class);
        let (votes, minor) = if direction.x_major {
            (&mut columns, height)
        } else {
            (&mut field, width)
        };
        sweeps.sweep(direction, |row| {
            table.add(row.ranges, &mut votes[row.major * minor..][..minor]);
        });
    }
    for (y, row) in field.chunks_exact_mut(width).enumerate() {
        for (x, votes) in row.iter_mut().enumerate() {
            *votes += columns[x * height + y];
            if grid.cells()[y * width + x] != Cell::Open {
                *votes = 0;
            }
        }
    }
    Some(field)
}
