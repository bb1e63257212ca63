//! Memory needed to prepare a map, estimated before any of it is allocated.

use super::SearchIndex;
use super::intervals::SIDE;
use crate::grid::Grid;
use crate::limits::Limits;
use crate::space::Space;

/// Bytes for each direction of each block of 4 × 4 cells in which poses are searched: three
/// for the intervals and, while these are built, up to 26 where they are wide, which on
/// real maps they are in at most 7 of a hundred. The sets are made when that memory is free
/// again, and take less.
const BYTES_A_DIRECTION: usize = 5;

/// Bytes for each cell of the map: its class, the bits that rays follow, and the sets of free and
/// of searched cells.
const BYTES_A_CELL: usize = 3;

/// Bytes needed for any map.
const BYTES_OF_ALL: usize = 1_000_000;

impl SearchIndex {
    /// Estimates the most bytes that are held at a time while the index of a map is prepared
    /// within limits, its cells included. It cannot be exact: how many intervals are wide shows
    /// only when they are built.
    #[must_use]
    pub fn needed_bytes(grid: &Grid, space: &Space, limits: &Limits) -> usize {
        let searched = limits.blocks(SIDE, grid).count();
        let by_blocks = searched * space.directions.count() * BYTES_A_DIRECTION;
        BYTES_OF_ALL + by_blocks + grid.cells().len() * BYTES_A_CELL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{grid_of, space_of};
    use messages::UNKNOWN;

    /// Rooms of 40 cells with doors on the left, clutter in the middle, and nothing known
    /// on the right.
    fn world() -> Grid {
        grid_of((400, 400), |x, y, noise| match x {
            0..150 => 100 * u8::from((x % 40 == 0 && y % 40 > 8) || (y % 40 == 0 && x % 40 > 8)),
            150..250 => 100 * u8::from(noise < 50),
            _ => UNKNOWN,
        })
    }

    #[test]
    fn what_is_kept_takes_less_than_preparing_but_not_much_less() {
        let grid = world();
        let space = space_of(&grid, 360);
        let limits = Limits::none(grid.width());
        let needed = SearchIndex::needed_bytes(&grid, &space, &limits);
        let kept = SearchIndex::within(&grid, &space, limits).bytes();
        assert!(kept < needed, "{kept} bytes of {needed}");
        assert!(needed < 2 * kept, "{kept} bytes of {needed}");
    }
}
