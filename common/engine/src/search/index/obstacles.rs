//! Cells that end a ray, as bits, so that adjacent rays are followed together.
//!
//! Directions with the same major axis move all rays of a bundle by one row at a time. In a
//! row of bits over the minor axis, adjacent rays are adjacent bits, and eight rows make
//! one word. Where no obstacle is near, rays leap.

use super::intervals::SIDE;
use crate::chessboard;
use crate::directions::{Direction, swap_unless};
use crate::grid::{Cell, Grid};

/// Number of rows of a word, and of adjacent rays in each.
pub(crate) const ROWS: i64 = 8;

/// Largest number of rays in a bundle.
pub(crate) const RAYS: usize = ROWS as usize;

/// Bits before the first and after the last column, for rays that leave the map.
const MARGIN: i64 = 32;

/// Bits from the start of a strip to that of the next one, `1 << STRIP`: half of the bits
/// of a strip. So all cells that adjacent rays meet in eight rows are in one strip.
const STRIP: u32 = 4;

/// Ray in the middle of those of a word.
const MIDDLE: i64 = 4;

/// Side of the tiles for which clearances hold, in cells: `1 << TILE`.
const TILE: u32 = 2;

/// The cells of a map that are not open, row by row along either axis.
#[derive(Debug, Clone)]
pub(crate) struct Obstacles {
    along_x: Rows,
    along_y: Rows,
    clearance: Clearance,
}

/// Distance from each tile of the map to the nearest obstacle, in tiles: the larger of the
/// distances along x and y, 0 in a tile that holds one. A margin of tiles without obstacles
/// surrounds the map.
#[derive(Debug, Clone)]
struct Clearance {
    columns: usize,
    tiles: Vec<u8>,
}

/// The cells as rows over the major axis, with empty ones before and after. They are cut
/// into strips that overlap, each row by row.
#[derive(Debug, Clone)]
struct Rows {
    /// Cells along the major axis.
    majors: i64,
    /// Cells along the minor axis.
    minors: i64,
    /// Rows of a strip.
    stride: usize,
    bits: Vec<u32>,
}

/// Adjacent rays along a direction.
#[derive(Debug)]
pub(crate) struct Rays<'a> {
    rows: &'a Rows,
    clearance: &'a Clearance,
    direction: &'a Direction,
    /// Coordinate of the first ray on the major axis, at position 0.
    major: i64,
    /// Coordinate of the first ray on the minor axis, less the direction's own rise.
    offset: i64,
}

impl Obstacles {
    pub(crate) fn new(grid: &Grid) -> Self {
        Obstacles {
            along_x: Rows::new(grid, true),
            along_y: Rows::new(grid, false),
            clearance: Clearance::new(grid),
        }
    }

    /// Allocates the obstacles of a grid, to be filled in.
    pub(crate) fn unfilled(grid: &Grid) -> Self {
        Obstacles {
            along_x: Rows::empty(grid, true),
            along_y: Rows::empty(grid, false),
            clearance: Clearance::unknown(grid),
        }
    }

    /// Returns the rows along either axis, and the clearances.
    pub(crate) fn parts(&self) -> ([&[u32]; 2], &[u8]) {
        let rows = [&self.along_x.bits[..], &self.along_y.bits];
        (rows, &self.clearance.tiles)
    }

    /// Returns the same, to be filled in.
    pub(crate) fn parts_mut(&mut self) -> ([&mut [u32]; 2], &mut [u8]) {
        let rows = [&mut self.along_x.bits[..], &mut self.along_y.bits];
        (rows, &mut self.clearance.tiles)
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let rows = self.along_x.bits.len() + self.along_y.bits.len();
        rows * size_of::<u32>() + self.clearance.tiles.len()
    }

    /// True if all cells of a small block are on the map and open.
    #[inline(always)]
    pub(crate) fn are_none_in(&self, (left, bottom): (usize, usize)) -> bool {
        let Rows {
            stride,
            bits,
            majors,
            minors,
        } = &self.along_x;
        let (strip, bit) = strip_of(bottom as i64 + MARGIN);
        let rows = &bits[strip * stride + ROWS as usize + left..];
        (left + SIDE) as i64 <= *majors
            && (bottom + SIDE) as i64 <= *minors
            && rows[..SIDE]
                .iter()
                .all(|row| row >> bit & ((1 << SIDE) - 1) == 0)
    }

    /// Returns rays in a direction, the first of which is at `(major, minor)` at position 0.
    pub(crate) fn rays<'a>(
        &'a self,
        direction: &'a Direction,
        (major, minor): (i64, i64),
    ) -> Rays<'a> {
        Rays {
            rows: match direction.x_major {
                true => &self.along_x,
                false => &self.along_y,
            },
            clearance: &self.clearance,
            direction,
            major,
            offset: minor - direction.minor(major),
        }
    }
}

impl Rows {
    /// Returns rows of the size of a grid without any obstacle.
    fn empty(grid: &Grid, x_major: bool) -> Self {
        let (majors, minors) = swap_unless(x_major, (grid.width(), grid.height()));
        let stride = majors + 2 * ROWS as usize;
        let strips = (minors + 2 * MARGIN as usize).div_ceil(1 << STRIP);
        Rows {
            majors: majors as i64,
            minors: minors as i64,
            stride,
            bits: vec![0; strips * stride],
        }
    }

    fn new(grid: &Grid, x_major: bool) -> Self {
        let mut rows = Self::empty(grid, x_major);
        let Rows { stride, bits, .. } = &mut rows;
        for cell in grid.places(|cell| cell != Cell::Open) {
            let (major, minor) = swap_unless(x_major, cell);
            let row = major + ROWS as usize;
            // The margin is wider than a strip, so that there is one before each.
            let (strip, bit) = strip_of(minor as i64 + MARGIN);
            bits[strip * *stride + row] |= 1 << bit;
            bits[(strip - 1) * *stride + row] |= 1 << (bit + (1 << STRIP));
        }
        rows
    }
}

/// Returns the last strip that starts at a bit or before it, and the bit's place there.
#[inline(always)]
fn strip_of(bit: i64) -> (usize, i64) {
    ((bit >> STRIP) as usize, bit & ((1 << STRIP) - 1))
}

impl Clearance {
    /// Returns the clearances of a map; cells beyond it are no obstacles.
    fn new(grid: &Grid) -> Self {
        let mut clearance = Self::unknown(grid);
        let columns = clearance.columns;
        for (x, y) in grid.places(|cell| cell != Cell::Open) {
            let tile = clearance.tile(x, y);
            clearance.tiles[tile] = 0;
        }
        chessboard::spread(&mut clearance.tiles, columns);
        clearance
    }

    /// Returns the clearances of a map on which no obstacle is known.
    fn unknown(grid: &Grid) -> Self {
        let tiles = |cells: usize| cells.div_ceil(1 << TILE) + 2;
        let (columns, rows) = (tiles(grid.width()), tiles(grid.height()));
        Clearance {
            columns,
            tiles: vec![u8::MAX; columns * rows],
        }
    }

    #[inline(always)]
    fn tile(&self, x: usize, y: usize) -> usize {
        ((y >> TILE) + 1) * self.columns + (x >> TILE) + 1
    }
}

impl Rays<'_> {
    /// Returns the number of positions from this one on at which no ray of a word can end,
    /// judged by the clearance near its middle; 0 if that is not known.
    #[inline(always)]
    pub(crate) fn free(&self, position: i64) -> i64 {
        let (major, minor) = self.at(MIDDLE as usize, position);
        if !(0..self.rows.minors).contains(&minor) {
            return 0;
        }
        let (x, y) = self.direction.swap((major, minor));
        let tile = self.clearance.tile(x as usize, y as usize);
        let tiles = i64::from(self.clearance.tiles[tile]);
        // Between a cell and the nearest obstacle lie whole tiles, all but one;
        // with each position a ray comes nearer by one cell at most.
        let between = (tiles - 1) << TILE;
        (between - MIDDLE + 1).max(0)
    }

    /// Number of positions on the map along the major axis.
    pub(crate) fn positions(&self) -> i64 {
        match self.direction.step > 0 {
            true => self.rows.majors - self.major,
            false => self.major + 1,
        }
    }

    /// Returns the cell of ray `i` at a position, as column and row.
    pub(crate) fn cell(&self, i: usize, position: i64) -> (i64, i64) {
        self.direction.swap(self.at(i, position))
    }

    /// Returns the same along the major and the minor axis.
    #[inline(always)]
    fn at(&self, i: usize, position: i64) -> (i64, i64) {
        let major = self.major + self.direction.step * position;
        (major, self.offset + i as i64 + self.direction.minor(major))
    }

    /// Returns the ends of eight rays at eight positions: bit `i` of byte `j` is set if ray `i`
    /// ends at `position + j`. Returns `None` if all of them have left the map; there must be a
    /// row at `position`.
    #[inline(always)]
    pub(crate) fn ends(&self, position: i64) -> Option<u64> {
        const ENOUGH: &str = "rows go on before the first and behind the last";
        let Rays {
            rows, direction, ..
        } = self;
        let major = self.major + direction.step * position;
        let rise = direction.rise(major);
        // Rays leave for good: a bundle never turns.
        let first = self.offset + (rise >> 32);
        if first <= -ROWS || first >= rows.minors {
            return None;
        }
        // Rows lie in memory as they do along the major axis.
        let slope = direction.slope() * direction.step;
        let (bit, last) = (rise, rise + (ROWS - 1) * slope);
        let (lowest, _) = strip_of(self.offset + MARGIN + (bit.min(last) >> 32));
        let before = (self.offset + MARGIN - ((lowest as i64) << STRIP)) << 32;
        let backward = direction.step < 0;
        let (top, bit, slope) = match backward {
            true => (major - (ROWS - 1), last, -slope),
            false => (major, bit, slope),
        };
        let start = lowest * rows.stride + (top + ROWS) as usize;
        let rows: &[u32; RAYS] = rows.bits[start..].first_chunk().expect(ENOUGH);
        let word = u64::from_le_bytes(std::array::from_fn(|row| {
            let bit = (before + bit + row as i64 * slope) >> 32;
            (rows[row] >> (bit & 31)) as u8
        }));
        Some(if backward { word.swap_bytes() } else { word })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, any_long_grid, space_of};

    proptest! {
        #[test]
        fn rays_end_where_a_cell_is_not_open(
            grid in prop_oneof![any_grid(), any_long_grid()], headings in 1u32..10, seed in any::<[usize; 2]>(), skip in 0i64..20,
        ) {
            let obstacles = Obstacles::new(&grid);
            let (x, y) = ((seed[0] % grid.width()) as i64, (seed[1] % grid.height()) as i64);
            for direction in space_of(&grid, headings * 8).directions.all() {
                let rays = obstacles.rays(direction, direction.swap((x, y)));
                prop_assert_eq!(rays.cell(0, 0), (x, y));
                if skip >= rays.positions() {
                    continue;
                }
                let ends = rays.ends(skip);
                for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
                    let (x, y) = rays.cell(i, skip + j);
                    let expected = grid.get(x, y).is_some_and(|cell| cell != Cell::Open);
                    let found = ends.unwrap_or(0) >> (8 * j + i as i64) & 1;
                    prop_assert_eq!(found == 1, expected, "{:?} {:?}", (i, j), direction);
                }
                for (i, on) in (0..8).flat_map(|i| (0..rays.free(skip)).map(move |on| (i, on))) {
                    let (x, y) = rays.cell(i, skip + on);
                    prop_assert!(grid.get(x, y).is_none_or(|cell| cell == Cell::Open));
                }
            }
        }
    }
}
