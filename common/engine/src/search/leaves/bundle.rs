//! The rays of one direction through a small block of cells.
//!
//! The cells of a column of the block are adjacent, and so are their rays. From column to
//! column all rays move together by one cell at most, so at most seven rays meet the block.

use crate::directions::Direction;
use crate::grid::{Cell, Grid};
use crate::program::NO_RANGE;
use crate::search::index::intervals::CELLS;
use crate::search::index::intervals::SIDE;
use crate::search::index::obstacles::{RAYS, ROWS, Rays};

/// Order in which rays cross the cells of a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Across {
    /// Number of columns that a ray has met before the cell.
    pub column: [u16; CELLS],
    /// Place of the cell in its column.
    pub minor: [u16; CELLS],
}

impl Across {
    /// Orders for rays along y and along x, each forward and backward.
    pub(crate) const ALL: [[Across; 2]; 2] = [
        [Across::new(false, false), Across::new(false, true)],
        [Across::new(true, false), Across::new(true, true)],
    ];

    const fn new(x_major: bool, backward: bool) -> Self {
        let (mut column, mut minor) = ([0; CELLS], [0; CELLS]);
        let mut cell = 0;
        while cell < CELLS {
            let (x, y) = ((cell % SIDE) as u16, (cell / SIDE) as u16);
            let (major, along) = if x_major { (x, y) } else { (y, x) };
            column[cell] = if backward {
                SIDE as u16 - 1 - major
            } else {
                major
            };
            minor[cell] = along;
            cell += 1;
        }
        Across { column, minor }
    }
}

/// Position at which each of adjacent rays ends first, or [`NO_RANGE`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hits(pub [u16; RAYS]);

impl Hits {
    /// Notes the rays that end at one of eight positions, unless they ended before. Bit `i` of
    /// byte `j` of the word is set if ray `i` ends at `position + j`. Returns a bit for each ray
    /// that ends in the word.
    #[inline(always)]
    pub(crate) fn note(&mut self, word: u64, position: i64) -> u8 {
        /// The bits of the first ray.
        const FIRST: u64 = 0x0101_0101_0101_0101;
        for (i, hit) in self.0.iter_mut().enumerate() {
            let ends = (word >> i) & FIRST;
            let at = position + i64::from(ends.trailing_zeros() / 8);
            let at = if ends == 0 { NO_RANGE } else { at as u16 };
            *hit = at.min(*hit);
        }
        let folded = word | word >> 32;
        let folded = folded | folded >> 16;
        (folded | folded >> 8) as u8
    }
}

/// The adjacent rays of a direction through a block. Positions count along the major axis
/// from the first of the block's columns that a ray meets; a column here is the cells with
/// the same index on the major axis, whichever axis that is.
pub(crate) struct Bundle {
    x_major: bool,
    /// True if rays run towards lower indices.
    backward: bool,
    /// Cell of the first ray at position 0, along major and minor axis.
    pub start: (i64, i64),
    /// Ray of the first cell of each column.
    first: [u16; SIDE],
    rays: u32,
}

impl Bundle {
    #[inline(always)]
    pub(crate) fn new(direction: &Direction, (left, bottom): (usize, usize)) -> Self {
        let x_major = direction.x_major;
        let (major, minor) = direction.swap((left, bottom));
        let backward = direction.step < 0;
        let major = major as i64 + if backward { SIDE as i64 - 1 } else { 0 };
        let (rise, slope) = (direction.rise(major), direction.slope() * direction.step);
        let shift = |column: usize| ((rise + slope * column as i64) >> 32) - (rise >> 32);
        // If rays rise, those of the first column are not the first.
        let lead = shift(SIDE - 1).max(0);
        Bundle {
            x_major,
            backward,
            start: (major, minor as i64 - lead),
            first: std::array::from_fn(|column| (lead - shift(column)) as u16),
            rays: SIDE as u32 + shift(SIDE - 1).unsigned_abs() as u32,
        }
    }

    /// Returns the bits of a first word that are after the last cell of their ray: in rows
    /// `0..SIDE - 1`, the rays of no later column.
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

    /// Returns the positions at which the rays of the block end. The steps from the block's
    /// cells to there are in one of two spans.
    #[inline(always)]
    pub(crate) fn follow(&self, rays: &Rays<'_>, spans: [(u16, u16); 2]) -> Hits {
        let mut hits = Hits([NO_RANGE; RAYS]);
        let mut pending = u8::MAX >> (RAYS as u32 - self.rays);
        let mut mask = self.behind();
        let mut done = 0;
        for (first, end) in spans {
            let end = (i64::from(end) + SIDE as i64 - 1).min(rays.positions());
            let mut position = i64::from(first).max(done);
            // As a rule a ray ends at the start of a span, so that is read before any leap.
            while position < end && pending != 0 {
                let Some(word) = rays.ends(position) else {
                    return hits;
                };
                let word = word & std::mem::replace(&mut mask, u64::MAX);
                let ended = hits.note(word, position);
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
        hits
    }

    /// Returns the order in which rays cross the block's cells.
    #[inline(always)]
    fn across(&self) -> &'static Across {
        &Across::ALL[usize::from(self.x_major)][usize::from(self.backward)]
    }

    /// Returns the ranges of the block's cells if all of them are open: the steps to the ends
    /// of their rays.
    #[inline(always)]
    pub(crate) fn ranges(&self, Hits(hits): &Hits) -> [u16; CELLS] {
        let Across { column, minor } = self.across();
        std::array::from_fn(|i| {
            let ray = self.first[usize::from(column[i])] + minor[i];
            let hit = hits[usize::from(ray) % RAYS];
            if hit == NO_RANGE {
                hit
            } else {
                hit - column[i]
            }
        })
    }

    /// Does the same if some cells are not open: the steps to those that are in the way, too.
    pub(crate) fn ranges_among(&self, Hits(mut hits): Hits, cells: &[Cell; CELLS]) -> [u16; CELLS] {
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

/// Drops the hits of rays that end in an unknown cell that blocks them: they have no range.
pub(crate) fn drop_blocked(rays: &Rays<'_>, grid: &Grid, Hits(hits): &mut Hits) {
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
