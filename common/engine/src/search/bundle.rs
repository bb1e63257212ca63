//! The rays of one direction through a small block of cells.
//!
//! The cells of a column of the block lie side by side, and so do their rays. From
//! column to column they move by one cell at most, all at once, so that no more
//! than seven rays meet the block.

use super::intervals::SIDE;
use super::obstacles::{ROWS, Rays};
use super::outlook::CELLS;
use crate::directions::{Direction, swap_unless};
use crate::grid::{Cell, Grid};
use crate::program::NO_RANGE;

/// The rays of a direction through a block, side by side. Positions count along
/// the major axis from the first of the block's columns that a ray meets; here a
/// column is what shares an index on the major axis, whichever that is.
pub(super) struct Bundle {
    x_major: bool,
    /// Whether rays run towards lower indices.
    backward: bool,
    /// Where the first ray stands at position 0, along major and minor axis.
    pub start: (i64, i64),
    /// The ray of the first cell of each column.
    first: [usize; SIDE],
    rays: u32,
}

/// The most rays that a block has, filled up to what one word holds.
const RAYS: usize = ROWS as usize;

impl Bundle {
    pub(super) fn new(direction: &Direction, (left, bottom): (usize, usize)) -> Self {
        let x_major = direction.x_major;
        let (major, minor) = direction.swap((left, bottom));
        let backward = direction.step < 0;
        let major = major as i64 + if backward { SIDE as i64 - 1 } else { 0 };
        let shift = |column: usize| {
            let at = major + direction.step * column as i64;
            direction.minor(at) - direction.minor(major)
        };
        // Where rays rise, those of the first column are not the first.
        let lead = shift(SIDE - 1).max(0);
        Bundle {
            x_major,
            backward,
            start: (major, minor as i64 - lead),
            first: std::array::from_fn(|column| (lead - shift(column)) as usize),
            rays: SIDE as u32 + shift(SIDE - 1).unsigned_abs() as u32,
        }
    }

    /// Those bits of a first word that lie behind the last cell of their ray: of
    /// the rows of `0..SIDE - 1`, the rays of no later column.
    fn behind(&self) -> u64 {
        let mut mask = u64::MAX;
        let mut later = 0u64;
        for column in (1..SIDE).rev() {
            later |= 0b1111 << self.first[column];
            mask &= !(later << (8 * (column - 1)));
        }
        mask
    }

    /// The positions at which the rays of the block end, which are some steps
    /// behind the last open cell of each: in one of two spans.
    pub(super) fn follow(&self, rays: &Rays<'_>, spans: [(u16, u16); 2]) -> [u16; RAYS] {
        let mut hits = [NO_RANGE; RAYS];
        let mut pending = (1u64 << self.rays) - 1;
        let mut mask = self.behind();
        let mut done = 0;
        for (first, end) in spans {
            let end = (i64::from(end) + SIDE as i64 - 1).min(rays.positions());
            let mut position = i64::from(first).max(done);
            while position < end && pending != 0 {
                let free = rays.free(position);
                if free > 0 {
                    let passed = !mask >> (8 * free.min(ROWS - 1));
                    mask = !passed;
                    position += free;
                    continue;
                }
                let Some(word) = rays.ends(position) else {
                    return hits;
                };
                let word = word & mask;
                mask = u64::MAX;
                note(&mut hits, word, position);
                let folded = word | word >> 32;
                let folded = folded | folded >> 16;
                pending &= !(folded | folded >> 8);
                position += ROWS;
            }
            done = position;
        }
        hits
    }

    /// The ranges of the block's cells: to where their rays end, or to a cell of
    /// the block that is in the way.
    pub(super) fn spread(
        &self,
        mut hits: [u16; RAYS],
        cells: &[Cell; CELLS],
        ranges: &mut [u16; CELLS],
    ) {
        for column in (0..SIDE).rev() {
            let major = if self.backward {
                SIDE - 1 - column
            } else {
                column
            };
            for minor in 0..SIDE {
                let (x, y) = swap_unless(self.x_major, (major, minor));
                let i = y * SIDE + x;
                let hit = &mut hits[self.first[column] + minor];
                *hit = match cells[i] {
                    Cell::Open => *hit,
                    Cell::Occupied => column as u16,
                    Cell::Blocked => NO_RANGE,
                };
                ranges[i] = if *hit == NO_RANGE {
                    NO_RANGE
                } else {
                    *hit - column as u16
                };
            }
        }
    }
}

/// Where a ray ends in a cell that it is lost in, it has no range.
pub(super) fn lose(rays: &Rays<'_>, grid: &Grid, hits: &mut [u16; RAYS]) {
    for (i, hit) in hits.iter_mut().enumerate() {
        if *hit == NO_RANGE {
            continue;
        }
        let (x, y) = rays.cell(i, i64::from(*hit));
        if grid.get(x, y) == Some(Cell::Blocked) {
            *hit = NO_RANGE;
        }
    }
}

/// Notes where rays end at one of eight positions, unless they did before.
#[inline(always)]
fn note(hits: &mut [u16; RAYS], word: u64, position: i64) {
    /// The bits of the first ray.
    const FIRST: u64 = 0x0101_0101_0101_0101;
    for (i, hit) in hits.iter_mut().enumerate() {
        let ends = (word >> i) & FIRST;
        let at = position + i64::from(ends.trailing_zeros() / 8);
        let at = if ends == 0 { NO_RANGE } else { at as u16 };
        *hit = at.min(*hit);
    }
}
