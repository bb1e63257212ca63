//! The rays of one direction through a small block of cells.
//!
//! The cells of a column of the block lie side by side, and so do their rays. From
//! column to column they move by one cell at most, all at once, so that no more
//! than seven rays meet the block.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::program::NO_RANGE;
use crate::search::index::intervals::CELLS;
use crate::search::index::intervals::SIDE;
use crate::search::index::obstacles::Rays;
use crate::simd::rays::{Across, RAYS, ROWS, RayLanes};

/// The rays of a direction through a block, side by side. Positions count along
/// the major axis from the first of the block's columns that a ray meets; here a
/// column is what shares an index on the major axis, whichever that is.
pub(in crate::search) struct Bundle {
    x_major: bool,
    /// Whether rays run towards lower indices.
    backward: bool,
    /// Where the first ray stands at position 0, along major and minor axis.
    pub start: (i64, i64),
    /// The ray of the first cell of each column.
    first: [u16; SIDE],
    rays: u32,
}

impl Bundle {
    #[inline(always)]
    pub(in crate::search) fn new(direction: &Direction, (left, bottom): (usize, usize)) -> Self {
        let x_major = direction.x_major;
        let (major, minor) = direction.swap((left, bottom));
        let backward = direction.step < 0;
        let major = major as i64 + if backward { SIDE as i64 - 1 } else { 0 };
        let (rise, slope) = (direction.rise(major), direction.slope() * direction.step);
        let shift = |column: usize| ((rise + slope * column as i64) >> 32) - (rise >> 32);
        // Where rays rise, those of the first column are not the first.
        let lead = shift(SIDE - 1).max(0);
        Bundle {
            x_major,
            backward,
            start: (major, minor as i64 - lead),
            first: std::array::from_fn(|column| (lead - shift(column)) as u16),
            rays: SIDE as u32 + shift(SIDE - 1).unsigned_abs() as u32,
        }
    }

    /// Those bits of a first word that lie behind the last cell of their ray: of
    /// the rows of `0..SIDE - 1`, the rays of no later column.
    #[inline(always)]
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
    #[inline(always)]
    pub(in crate::search) fn follow<L: RayLanes>(
        &self,
        set: L::Set,
        rays: &Rays<'_>,
        spans: [(u16, u16); 2],
    ) -> [u16; RAYS] {
        let mut hits = L::none(set);
        let mut pending = u8::MAX >> (RAYS as u32 - self.rays);
        let mut mask = self.behind();
        let mut done = 0;
        for (first, end) in spans {
            let end = (i64::from(end) + SIDE as i64 - 1).min(rays.positions());
            let mut position = i64::from(first).max(done);
            // A span starts where a ray ends, as a rule: that is looked at first.
            while position < end && pending != 0 {
                let Some(word) = rays.ends::<L>(set, position) else {
                    return hits.hits();
                };
                let word = word & std::mem::replace(&mut mask, u64::MAX);
                let ended;
                (hits, ended) = hits.note(word, position);
                pending &= !ended;
                position += ROWS;
                while position < end && pending != 0 {
                    let free = rays.free(position);
                    if free == 0 {
                        break;
                    }
                    position += free;
                }
            }
            done = position;
        }
        hits.hits()
    }

    /// Where the block's cells lie.
    #[inline(always)]
    fn across(&self) -> &'static Across {
        &Across::ALL[usize::from(self.x_major)][usize::from(self.backward)]
    }

    /// The ranges of the block's cells, all of them open: to where their rays end.
    #[inline(always)]
    pub(in crate::search) fn ranges<L: RayLanes>(
        &self,
        set: L::Set,
        hits: &[u16; RAYS],
    ) -> [u16; CELLS] {
        L::ranges(set, hits, &self.first, self.across())
    }

    /// The same where some cells are not: to those that are in the way.
    pub(in crate::search) fn ranges_among(
        &self,
        mut hits: [u16; RAYS],
        cells: &[Cell; CELLS],
    ) -> [u16; CELLS] {
        let Across { column, minor } = self.across();
        let mut ranges = [NO_RANGE; CELLS];
        for behind in (0..SIDE as u16).rev() {
            for i in (0..CELLS).filter(|&i| column[i] == behind) {
                let hit = &mut hits[usize::from(self.first[usize::from(behind)] + minor[i])];
                *hit = match cells[i] {
                    Cell::Open => *hit,
                    Cell::Occupied => behind,
                    Cell::Blocked => NO_RANGE,
                };
                if *hit != NO_RANGE {
                    ranges[i] = *hit - behind;
                }
            }
        }
        ranges
    }
}

/// Where a ray ends in an unknown cell that blocks it, it has no range.
pub(in crate::search) fn drop_blocked(rays: &Rays<'_>, grid: &Grid, hits: &mut [u16; RAYS]) {
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
