//! Between which ranges the cells of a block see: what bounds their votes.
//!
//! For each block of cells and each direction, the shortest and the
//! longest range of any open cell of the block are kept. A reading's votes
//! fall off on both sides of its taper, so no cell of the block can have more
//! than the nearest range in between would give.

use crate::directions::Directions;
use crate::grid::{Cell, Grid};
use crate::lines::NO_RANGE;
use crate::sweep::SweepGrid;

/// Directions that are pooled at a time: 32 ranges fill a cache line of the
/// tables, which are written block by block.
const BATCH: usize = 32;

/// Intervals of ranges by block and direction.
#[derive(Debug, Clone)]
pub struct Intervals {
    /// Cells along the side of a block.
    pub side: usize,
    /// Blocks along x.
    pub columns: usize,
    /// Blocks along y.
    pub rows: usize,
    directions: usize,
    /// Shortest range of block `b` in direction `d` at `b · directions + d`;
    /// [`NO_RANGE`] where no cell has one.
    nearest: Vec<u16>,
    /// One more than the longest range; 0 where no cell has one.
    end: Vec<u16>,
}

impl Intervals {
    /// Shortest ranges of a block by direction, and one more than the longest.
    #[must_use]
    pub fn block(&self, block: usize) -> (&[u16], &[u16]) {
        let entries = block * self.directions..(block + 1) * self.directions;
        (&self.nearest[entries.clone()], &self.end[entries])
    }

    /// Bytes that the intervals take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        2 * (self.nearest.len() + self.end.len())
    }

    fn empty(side: usize, columns: usize, rows: usize, directions: usize) -> Self {
        let entries = columns * rows * directions;
        Intervals {
            side,
            columns,
            rows,
            directions,
            nearest: vec![NO_RANGE; entries],
            end: vec![0; entries],
        }
    }

    /// Pools the ranges of all open cells in blocks of `side` cells.
    #[must_use]
    pub fn new(grid: &Grid, side: usize, directions: &Directions) -> Self {
        let (columns, rows) = (grid.width().div_ceil(side), grid.height().div_ceil(side));
        let mut intervals = Intervals::empty(side, columns, rows, directions.count());
        let mut pool = Pool::new(grid, side);
        let mut planes = vec![Plane::new(columns * rows); BATCH.min(directions.count())];
        for first in (0..directions.count()).step_by(BATCH) {
            let batch = &directions.all()[first..directions.count().min(first + BATCH)];
            for (direction, plane) in batch.iter().zip(&mut planes) {
                pool.sweep(direction, plane);
            }
            for block in 0..columns * rows {
                let entries = block * directions.count() + first..;
                for (entry, plane) in intervals.nearest[entries.clone()]
                    .iter_mut()
                    .zip(&planes[..batch.len()])
                {
                    *entry = plane.nearest[block];
                }
                for (entry, plane) in intervals.end[entries]
                    .iter_mut()
                    .zip(&planes[..batch.len()])
                {
                    *entry = plane.end[block];
                }
            }
        }
        intervals
    }

    /// Those of blocks that join two by two of these.
    #[must_use]
    pub fn coarser(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let mut intervals = Intervals::empty(2 * self.side, columns, rows, self.directions);
        for (y, x) in (0..self.rows).flat_map(|y| (0..self.columns).map(move |x| (y, x))) {
            let (nearest, end) = self.block(y * self.columns + x);
            let first = (y / 2 * columns + x / 2) * self.directions;
            for (joined, &finer) in intervals.nearest[first..].iter_mut().zip(nearest) {
                *joined = finer.min(*joined);
            }
            for (joined, &finer) in intervals.end[first..].iter_mut().zip(end) {
                *joined = finer.max(*joined);
            }
        }
        intervals
    }
}

/// Intervals of all blocks in one direction.
#[derive(Debug, Clone)]
struct Plane {
    nearest: Vec<u16>,
    end: Vec<u16>,
}

impl Plane {
    fn new(blocks: usize) -> Self {
        Plane {
            nearest: vec![NO_RANGE; blocks],
            end: vec![0; blocks],
        }
    }
}

/// Pools the rows of range sweeps into blocks.
struct Pool {
    sweeps: SweepGrid,
    side: usize,
    width: usize,
    height: usize,
    /// All ones where the robot may stand, by row and by column.
    open_by_row: Vec<u16>,
    open_by_column: Vec<u16>,
    nearest: Vec<u16>,
    end: Vec<u16>,
}

impl Pool {
    fn new(grid: &Grid, side: usize) -> Self {
        let (width, height) = (grid.width(), grid.height());
        let open = |i: usize| {
            if grid.cells()[i] == Cell::Open {
                u16::MAX
            } else {
                0
            }
        };
        let longest = width.max(height);
        Pool {
            sweeps: SweepGrid::new(grid),
            side,
            width,
            height,
            open_by_row: (0..width * height).map(open).collect(),
            open_by_column: (0..width)
                .flat_map(|x| (0..height).map(move |y| open(y * width + x)))
                .collect(),
            nearest: vec![NO_RANGE; longest],
            end: vec![0; longest],
        }
    }

    /// Fills a plane with the intervals of all blocks in one direction.
    fn sweep(&mut self, direction: &crate::directions::Direction, plane: &mut Plane) {
        let Pool {
            sweeps,
            side,
            width,
            height,
            open_by_row,
            open_by_column,
            nearest,
            end,
        } = self;
        let (side, columns) = (*side, width.div_ceil(*side));
        let (open, minor, majors) = if direction.x_major {
            (open_by_column, *height, *width)
        } else {
            (open_by_row, *width, *height)
        };
        let (nearest, end) = (&mut nearest[..minor], &mut end[..minor]);
        sweeps.sweep(direction, |row| {
            let open = &open[row.major * minor..][..minor];
            for (((nearest, end), &range), &open) in
                nearest.iter_mut().zip(&mut *end).zip(row.ranges).zip(open)
            {
                // Closed cells turn into no range, which both sides ignore.
                *nearest = (*nearest).min(range | !open);
                *end = (*end).max(range.wrapping_add(1) & open);
            }
            let is_last = if direction.step > 0 {
                row.major.is_multiple_of(side)
            } else {
                (row.major + 1).is_multiple_of(side) || row.major + 1 == majors
            };
            if !is_last {
                return;
            }
            let along = row.major / side;
            for (across, (nearest, end)) in nearest.chunks(side).zip(end.chunks(side)).enumerate() {
                let (x, y) = if direction.x_major {
                    (along, across)
                } else {
                    (across, along)
                };
                plane.nearest[y * columns + x] = nearest.iter().copied().min().unwrap_or(NO_RANGE);
                plane.end[y * columns + x] = end.iter().copied().max().unwrap_or(0);
            }
            nearest.fill(NO_RANGE);
            end.fill(0);
        });
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::testing::{any_grid, space_of};

    proptest! {
        #[test]
        fn intervals_are_tight_around_the_ranges_of_their_open_cells(grid in any_grid(), headings in 1u32..8) {
            let space = space_of(&grid, headings * 8);
            let fine = Intervals::new(&grid, 4, &space.directions);
            for level in [&fine, &fine.coarser()] {
                for (block, d) in (0..level.columns * level.rows).flat_map(|b| (0..space.directions.count()).map(move |d| (b, d))) {
                    let (x0, y0) = (block % level.columns * level.side, block / level.columns * level.side);
                    let cells = (y0..y0 + level.side).flat_map(|y| (x0..x0 + level.side).map(move |x| (x as i64, y as i64)));
                    let ranges: Vec<u16> = cells
                        .filter(|&(x, y)| grid.is_open(x, y))
                        .filter_map(|(x, y)| reference::range(&grid, x, y, space.directions.get(d)))
                        .collect();
                    let (nearest, end) = level.block(block);
                    prop_assert_eq!(nearest[d], ranges.iter().copied().min().unwrap_or(NO_RANGE));
                    prop_assert_eq!(end[d], ranges.iter().max().map_or(0, |&range| range + 1));
                }
            }
        }
    }
}
