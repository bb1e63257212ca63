//! Exact ranges of the cells of a small block, in directions as they are asked
//! for.
//!
//! The block's intervals say how far away the first obstacle lies at least, so
//! a ray is followed cell by cell only from there. Cells behind one another on
//! a line share a ray: only the one at the block's edge is followed.

use super::intervals::{BlockIntervals, RangeIntervals, SIDE};
use super::steps::BinSteps;
use crate::directions::{Direction, Directions};
use crate::grid::{Cell, Grid};
use crate::limits::Limits;
use crate::program::NO_RANGE;

/// Cells of a block, row by row.
pub(crate) const CELLS: usize = SIDE * SIDE;

/// What one block sees.
#[derive(Debug, Clone)]
pub(crate) struct Outlook {
    by_direction: Vec<[u16; CELLS]>,
    /// The block for which each direction was looked in last, by its number.
    looked_for: Vec<u32>,
    /// Counts the blocks.
    number: u32,
    left: usize,
    bottom: usize,
    cells: [Cell; CELLS],
    /// For each cell, all ones where poses are sought.
    open: [u16; CELLS],
    intervals: BlockIntervals,
    /// Whether rays can be lost on the map: then they must be followed from the
    /// start, as intervals say only where they hit.
    can_lose: bool,
    /// How often a direction was looked in.
    looks: u64,
}

impl Default for Outlook {
    fn default() -> Self {
        Outlook {
            by_direction: Vec::new(),
            looked_for: Vec::new(),
            number: 0,
            left: 0,
            bottom: 0,
            cells: [Cell::Blocked; CELLS],
            open: [0; CELLS],
            intervals: BlockIntervals::default(),
            can_lose: false,
            looks: 0,
        }
    }
}

impl Outlook {
    /// Turns to a map. What was looked at before is forgotten with the next
    /// block, whose number nothing has yet.
    pub(crate) fn prepare(&mut self, grid: &Grid, directions: &Directions) {
        let count = directions.count();
        self.by_direction.resize(count, [NO_RANGE; CELLS]);
        self.looked_for.resize(count, 0);
        self.can_lose = grid.has_blocked();
        self.looks = 0;
    }

    /// Turns to a block.
    pub(crate) fn enter(
        &mut self,
        (grid, limits): (&Grid, &Limits),
        intervals: &RangeIntervals,
        block: usize,
    ) {
        if self.number == u32::MAX {
            self.looked_for.fill(0);
            self.number = 0;
        }
        self.number += 1;
        intervals.read(block, &mut self.intervals);
        self.left = block % intervals.columns * SIDE;
        self.bottom = block / intervals.columns * SIDE;
        let cells = self.cells.iter_mut().zip(&mut self.open);
        for (i, (cell, open)) in cells.enumerate() {
            let (x, y) = (self.left + i % SIDE, self.bottom + i / SIDE);
            *cell = grid.get(x as i64, y as i64).unwrap_or(Cell::Blocked);
            let sought = *cell == Cell::Open && limits.hold_cell(x, y);
            *open = if sought { u16::MAX } else { 0 };
        }
    }

    /// Column and row of the block's cell `i`.
    pub(crate) fn cell(&self, i: usize) -> (usize, usize) {
        (self.left + i % SIDE, self.bottom + i / SIDE)
    }

    /// The block's intervals.
    pub(crate) fn intervals(&self) -> &BlockIntervals {
        &self.intervals
    }

    /// For each cell, all ones where the robot may stand and is sought.
    pub(crate) fn open(&self) -> [u16; CELLS] {
        self.open
    }

    /// Looks in direction `d`, unless that was done for this block.
    #[inline(always)]
    pub(crate) fn look(
        &mut self,
        grid: &Grid,
        steps: &BinSteps,
        directions: &Directions,
        d: usize,
    ) {
        if self.looked_for[d] != self.number {
            self.looked_for[d] = self.number;
            self.looks += 1;
            self.look_anew(grid, steps, directions.get(d), d);
        }
    }

    /// How often a direction of any block was looked in.
    pub(crate) fn looks(&self) -> u64 {
        self.looks
    }

    /// The ranges in direction `d`, in steps; it must have been looked in.
    #[inline(always)]
    pub(crate) fn ranges(&self, d: usize) -> &[u16; CELLS] {
        &self.by_direction[d]
    }

    fn look_anew(&mut self, grid: &Grid, steps: &BinSteps, direction: &Direction, d: usize) {
        let [near_first, near_last, far_first, far_last] = &self.intervals.rows;
        let near = steps.span(direction.class, near_first[d], near_last[d]);
        let far = steps.span(direction.class, far_first[d], far_last[d]);
        let spans = if self.can_lose {
            [(1, near.1.max(far.1)), (0, 0)]
        } else {
            [near, far]
        };
        let corner = (self.left, self.bottom);
        let ranges = &mut self.by_direction[d];
        if direction.x_major {
            sweep::<true>(grid, direction, corner, &self.cells, spans, ranges);
        } else {
            sweep::<false>(grid, direction, corner, &self.cells, spans, ranges);
        }
    }
}

/// Ranges of all cells along one direction: those at the block's far edge by
/// following the ray, the others from the next cell.
fn sweep<const X_MAJOR: bool>(
    grid: &Grid,
    direction: &Direction,
    (left, bottom): (usize, usize),
    cells: &[Cell; CELLS],
    spans: [(u16, u16); 2],
    ranges: &mut [u16; CELLS],
) {
    let (origin, first_minor) = if X_MAJOR {
        (left, bottom)
    } else {
        (bottom, left)
    };
    let index = |major: usize, minor: usize| {
        if X_MAJOR {
            minor * SIDE + major
        } else {
            major * SIDE + minor
        }
    };
    for i in 0..SIDE {
        let major = if direction.step > 0 { SIDE - 1 - i } else { i };
        let at = (origin + major) as i64;
        let shift = direction.minor(at + direction.step) - direction.minor(at);
        let next_major = (major as i64 + direction.step) as usize;
        for minor in 0..SIDE {
            let next_minor = (minor as i64 + shift) as usize;
            let i = index(major, minor);
            ranges[i] = match cells[i] {
                Cell::Occupied => 0,
                Cell::Blocked => NO_RANGE,
                Cell::Open if next_major < SIDE && next_minor < SIDE => {
                    ranges[index(next_major, next_minor)].saturating_add(1)
                }
                Cell::Open => {
                    let from = (at, (first_minor + minor) as i64);
                    follow::<X_MAJOR>(grid, direction, from, spans)
                }
            };
        }
    }
}

/// The range from an open cell, which lies in one of two spans of steps; where
/// it lies in neither, there is none.
#[inline(always)]
fn follow<const X_MAJOR: bool>(
    grid: &Grid,
    direction: &Direction,
    (major, minor): (i64, i64),
    spans: [(u16, u16); 2],
) -> u16 {
    let (width, height) = (grid.width() as i64, grid.height() as i64);
    let (majors, minors, major_stride, minor_stride) = if X_MAJOR {
        (width, height, 1, width)
    } else {
        (height, width, width, 1)
    };
    let (cells, step) = (grid.cells(), direction.step);
    let line = minor - direction.minor(major);
    // Steps with which the ray leaves the map along the major axis.
    let limit = if step > 0 { majors - major } else { major + 1 };
    let mut done = 0;
    for (first, end) in spans {
        let first = i64::from(first).max(done);
        let end = i64::from(end).min(limit);
        let mut place = (major + step * first) * major_stride;
        let mut rise = direction.rise(major + step * first);
        for steps in first..end {
            let minor = line + (rise >> 32);
            if !(0..minors).contains(&minor) {
                return NO_RANGE;
            }
            match cells[(place + minor * minor_stride) as usize] {
                Cell::Open => (),
                Cell::Occupied => return steps as u16,
                Cell::Blocked => return NO_RANGE,
            }
            place += step * major_stride;
            rise += direction.slope() * step;
        }
        done = end;
    }
    NO_RANGE
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bins::Bins;
    use super::*;
    use crate::reference;
    use crate::testing::{any_grid, space_of};

    proptest! {
        #[test]
        fn ranges_equal_those_of_stepping_along_each_ray(grid in any_grid(), headings in 1u32..10) {
            let directions = &space_of(&grid, headings * 8).directions;
            let bins = Bins::new(directions);
            let steps = BinSteps::new(&bins, directions, grid.width().max(grid.height()) as u16);
            let intervals = RangeIntervals::new(&grid, directions, &bins);
            let mut outlook = Outlook::default();
            outlook.prepare(&grid, directions);
            for block in 0..intervals.columns * intervals.rows {
                outlook.enter((&grid, &Limits::none(grid.width())), &intervals, block);
                let open = outlook.open();
                for (d, direction) in directions.all().iter().enumerate() {
                    outlook.look(&grid, &steps, directions, d);
                    for (i, &open) in open.iter().enumerate() {
                        let (x, y) = outlook.cell(i);
                        let (x, y) = (x as i64, y as i64);
                        prop_assert_eq!(open != 0, grid.is_open(x, y));
                        if grid.is_open(x, y) {
                            let plain = reference::range(&grid, x, y, direction).unwrap_or(NO_RANGE);
                            prop_assert_eq!(outlook.ranges(d)[i], plain, "{:?} {:?}", (x, y), direction);
                        }
                    }
                }
            }
        }
    }
}
