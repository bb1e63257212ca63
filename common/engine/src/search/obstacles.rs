//! What ends a ray, as bits, so that rays side by side are followed together.
//!
//! Directions with the same major axis move all rays of a bundle by one row at a
//! time. In a row of bits over the minor axis, rays side by side are bits side by
//! side, and eight rows make one word. Where nothing is near they leap.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};

/// Bits before the first and after the last column, for rays that leave the map.
const MARGIN: i64 = 32;

/// Rows of a word, and rays side by side in each.
pub(crate) const ROWS: i64 = 8;

/// The middle of the rays of a word.
const MIDDLE: i64 = 4;

/// Cells a side of what one clearance holds for, `1 << TILE`.
const TILE: u32 = 2;

/// The cells of a map that are not open, row by row along either axis.
#[derive(Debug, Clone)]
pub(crate) struct Obstacles {
    along_x: Rows,
    along_y: Rows,
    clearance: Clearance,
}

/// How far away the nearest obstacle of each tile of the map is, in tiles: the
/// larger of the distances along x and y, 0 in a tile that holds one.
#[derive(Debug, Clone)]
struct Clearance {
    columns: usize,
    tiles: Vec<u8>,
}

/// The cells as rows over the major axis, with empty ones before and after.
#[derive(Debug, Clone)]
struct Rows {
    /// Cells along the major axis.
    majors: i64,
    /// Cells along the minor axis.
    minors: i64,
    /// Bytes of a row.
    stride: usize,
    bits: Vec<u8>,
}

/// Rays side by side on their way along a direction.
#[derive(Debug)]
pub(crate) struct Rays<'a> {
    rows: &'a Rows,
    clearance: &'a Clearance,
    direction: &'a Direction,
    /// Where the first ray stands at position 0, along the major axis.
    major: i64,
    /// What the first ray has on the minor axis beyond the direction's own rise.
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

    /// Bytes that they take.
    pub(crate) fn bytes(&self) -> usize {
        self.along_x.bits.len() + self.along_y.bits.len() + self.clearance.tiles.len()
    }

    /// Rays in a direction, of which the first one stands at `(major, minor)` at
    /// position 0.
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
    fn new(grid: &Grid, x_major: bool) -> Self {
        let (width, height) = (grid.width(), grid.height());
        let (majors, minors) = match x_major {
            true => (width, height),
            false => (height, width),
        };
        let stride = (minors + 2 * MARGIN as usize).div_ceil(8);
        let mut bits = vec![0; stride * (majors + 2 * ROWS as usize)];
        let cells = grid.cells().iter().enumerate();
        for (i, _) in cells.filter(|&(_, &cell)| cell != Cell::Open) {
            let (x, y) = (i % width, i / width);
            let (major, minor) = if x_major { (x, y) } else { (y, x) };
            let bit = minor + MARGIN as usize;
            bits[(major + ROWS as usize) * stride + bit / 8] |= 1 << (bit % 8);
        }
        Rows {
            majors: majors as i64,
            minors: minors as i64,
            stride,
            bits,
        }
    }
}

impl Clearance {
    /// Of a map; what lies beyond it is no obstacle.
    fn new(grid: &Grid) -> Self {
        let tiles = |cells: usize| cells.div_ceil(1 << TILE);
        let (columns, rows) = (tiles(grid.width()), tiles(grid.height()));
        let mut clearance = Clearance {
            columns,
            tiles: vec![u8::MAX; columns * rows],
        };
        let cells = grid.cells().iter().enumerate();
        for (i, _) in cells.filter(|&(_, &cell)| cell != Cell::Open) {
            let (x, y) = (i % grid.width(), i / grid.width());
            clearance.tiles[(y >> TILE) * columns + (x >> TILE)] = 0;
        }
        clearance.spread();
        clearance
    }

    /// Two passes over the tiles, each from the four neighbours that it has been
    /// to: with steps of one in all eight directions that is exact.
    fn spread(&mut self) {
        let (columns, count) = (self.columns, self.tiles.len());
        for i in 0..count {
            self.hear(i, i % columns, |back| i.checked_sub(back));
        }
        for i in (0..count).rev() {
            let from = |on: usize| Some(i + on).filter(|&i| i < count);
            self.hear(i, columns - 1 - i % columns, from);
        }
    }

    /// One tile hears of those before it, `behind` of which are in its row.
    fn hear(&mut self, i: usize, behind: usize, at: impl Fn(usize) -> Option<usize>) {
        let columns = self.columns;
        let ahead = columns - 1 - behind;
        let neighbours = [
            (behind > 0, 1),
            (behind > 0, columns + 1),
            (true, columns),
            (ahead > 0, columns.saturating_sub(1)),
        ];
        let neighbours = neighbours.into_iter().filter(|&(is, _)| is);
        let heard = neighbours.filter_map(|(_, back)| at(back));
        let least = heard.map(|i| self.tiles[i]).min().unwrap_or(u8::MAX);
        self.tiles[i] = self.tiles[i].min(least.saturating_add(1));
    }
}

impl Rays<'_> {
    /// For how many positions from this one on no ray of a word can end, by what
    /// is near its middle; 0 where that is not known.
    #[inline(always)]
    pub(crate) fn free(&self, position: i64) -> i64 {
        let (major, minor) = self.cell(MIDDLE as usize, position);
        if !(0..self.rows.minors).contains(&minor) {
            return 0;
        }
        let (x, y) = match self.direction.x_major {
            true => (major, minor),
            false => (minor, major),
        };
        let tile = (y >> TILE) as usize * self.clearance.columns + (x >> TILE) as usize;
        let tiles = i64::from(self.clearance.tiles[tile]);
        // Between a cell and the nearest obstacle lie whole tiles, all but one;
        // with each position a ray comes nearer by one cell at most.
        let between = (tiles - 1) << TILE;
        (between - MIDDLE + 1).max(0)
    }

    /// Positions on the map along the major axis.
    pub(crate) fn positions(&self) -> i64 {
        match self.direction.step > 0 {
            true => self.rows.majors - self.major,
            false => self.major + 1,
        }
    }

    /// The cell of ray `i` at a position, along the major and the minor axis.
    pub(crate) fn cell(&self, i: usize, position: i64) -> (i64, i64) {
        let major = self.major + self.direction.step * position;
        (major, self.offset + i as i64 + self.direction.minor(major))
    }

    /// What ends eight rays at eight positions: bit `i` of byte `j` says whether
    /// ray `i` ends at `position + j`. `None` where all of them have left the map;
    /// there must be a row at `position`.
    #[inline(always)]
    pub(crate) fn ends(&self, position: i64) -> Option<u64> {
        let Rays {
            rows, direction, ..
        } = self;
        let major = self.major + direction.step * position;
        let mut rise = direction.rise(major);
        // Rays leave for good: a bundle never turns.
        let first = self.offset + (rise >> 32);
        if first <= -ROWS || first >= rows.minors {
            return None;
        }
        let stride = rows.stride as i64 * direction.step;
        let mut start = (major + ROWS) * rows.stride as i64;
        let slope = direction.slope() * direction.step;
        let mut word = 0;
        for j in 0..ROWS {
            let bit = self.offset + (rise >> 32) + MARGIN;
            let byte = (start + (bit >> 3)) as usize;
            let pair = u16::from_le_bytes([rows.bits[byte], rows.bits[byte + 1]]);
            word |= u64::from((pair >> (bit & 7)) as u8) << (8 * j);
            rise += slope;
            start += stride;
        }
        Some(word)
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
                let start = if direction.x_major { (x, y) } else { (y, x) };
                let rays = obstacles.rays(direction, start);
                prop_assert_eq!(rays.cell(0, 0), start);
                if skip >= rays.positions() {
                    continue;
                }
                let ends = rays.ends(skip);
                for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
                    let (major, minor) = rays.cell(i, skip + j);
                    let (x, y) = if direction.x_major { (major, minor) } else { (minor, major) };
                    let expected = grid.get(x, y).is_some_and(|cell| cell != Cell::Open);
                    let found = ends.unwrap_or(0) >> (8 * j + i as i64) & 1;
                    prop_assert_eq!(found == 1, expected, "{:?} {:?}", (i, j), direction);
                }
                for (i, on) in (0..8).flat_map(|i| (0..rays.free(skip)).map(move |on| (i, on))) {
                    let (major, minor) = rays.cell(i, skip + on);
                    let (x, y) = if direction.x_major { (major, minor) } else { (minor, major) };
                    prop_assert!(grid.get(x, y).is_none_or(|cell| cell == Cell::Open));
                }
            }
        }
    }
}
