//! Core of the node: computes the boundary of a map.

use engine::EngineError;
use engine::boundary;
use engine::grid::{CellRules, Grid, GridFrame};
use messages::{BoundaryCell, BoundaryHeader, MapHeader};

use crate::BoundaryError;

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Extraction {
    pub header: BoundaryHeader,
    /// Boundary cells, ordered by (y, x).
    pub cells: Vec<BoundaryCell>,
}

/// Extracts the boundary of a map with the cells `occupancy`; fails if it has none.
pub fn extract(map: &MapHeader, occupancy: &[u8]) -> Result<Extraction, BoundaryError> {
    // The boundary does not need the frame, but its users do: an unusable map should be rejected
    // before other nodes prepare for it.
    GridFrame::of(map)?;
    let rules = CellRules::of(map).map_err(EngineError::from)?;
    let (width, height) = (map.width as usize, map.height as usize);
    let grid = Grid::new(width, height, occupancy, rules)?;
    grid.check_use()?;
    let cells = boundary::extract(&grid);
    if cells.is_empty() {
        let occupied = grid.occupied_cells();
        return Err(BoundaryError::NoBoundaryCell { occupied });
    }
    let header = BoundaryHeader {
        stamp: map.stamp,
        map_id: map.map_id,
        free_cells: grid.free_cells() as u64,
        boundary_cells: cells.len() as u64,
        occupied_cells: grid.occupied_cells() as u64,
    };
    Ok(Extraction { header, cells })
}

#[cfg(test)]
mod tests {
    use messages::{Stamp, UNKNOWN};

    use super::*;

    fn map(width: u32, height: u32) -> MapHeader {
        MapHeader {
            stamp: Stamp {
                measured_ns: 1,
                entered_ns: 2,
                counter: 3,
            },
            map_id: 77,
            width,
            height,
            resolution_m: 0.05,
            ..MapHeader::default()
        }
    }

    /// Walls along the left, unknown cells along the right.
    const CELLS: [u8; 12] = [
        100, 100, 0, UNKNOWN, //
        100, 100, 0, UNKNOWN, //
        100, 100, 0, UNKNOWN,
    ];

    #[track_caller]
    fn refused(map: &MapHeader, cells: &[u8], expected: &str) {
        let error = extract(map, cells).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }

    #[test]
    fn the_boundary_comes_with_its_map_and_counts() {
        let map = MapHeader {
            unknown_blocks: 1,
            ..map(4, 3)
        };
        let Extraction { header, cells } = extract(&map, &CELLS).unwrap();
        let expected = [0, 1, 2].map(|y| BoundaryCell { x: 1, y });
        assert_eq!(cells, expected);
        assert_eq!((header.stamp, header.map_id), (map.stamp, 77));
        assert_eq!((header.free_cells, header.boundary_cells), (3, 3));
        assert_eq!(header.occupied_cells, 6);
    }

    #[test]
    fn a_map_that_nobody_can_use_is_refused() {
        refused(&map(0, 3), &[], "0 x 3 cells");
        refused(&map(32_768, 1), &[0; 32_768], "32768 x 1 cells");
        refused(&map(4, 3), &CELLS[..11], "11 occupancies instead of 12");
        refused(&map(u32::MAX, u32::MAX), &CELLS, "1 to 32767");
        refused(&map(2, 1), &[0, UNKNOWN], "no occupied cell");
        refused(&map(2, 1), &[100, UNKNOWN], "no free cell");
        let absurd = MapHeader {
            resolution_m: f64::NAN,
            ..map(4, 3)
        };
        refused(&absurd, &CELLS, "allowed: 0.001..=10 m");
    }

    #[test]
    fn obstacles_that_no_ray_reaches_are_no_map() {
        let map = MapHeader {
            unknown_blocks: 1,
            ..map(4, 1)
        };
        let unseen = "1 occupied cells, but none touches";
        refused(&map, &[100, UNKNOWN, UNKNOWN, 0], unseen);
    }
}
