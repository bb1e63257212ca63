//! Distance fields drawn as text for tests: `#` is occupied, `?` unknown, all else free. The last
//! line is the lowest row; cells have sides of 0.1 m.

use geometry::Pose;
use messages::UNKNOWN;

use super::DistanceField;
use crate::grid::{Cell, CellRules, Grid, GridFrame};

pub(crate) fn distance_field(rows: &[&str]) -> DistanceField {
    let cell = |cell| match cell {
        b'#' => 100,
        b'?' => UNKNOWN,
        _ => 0,
    };
    let occupancy: Vec<u8> = rows
        .iter()
        .rev()
        .flat_map(|row| row.bytes())
        .map(cell)
        .collect();
    of_cells((rows[0].len(), rows.len()), &occupancy)
}

/// Distance field of a grid.
pub(crate) fn field_of(grid: &Grid) -> DistanceField {
    let occupancy = |cell: &Cell| match cell {
        Cell::Occupied => 100,
        Cell::Open => 0,
        Cell::Blocked => UNKNOWN,
    };
    let occupancy: Vec<u8> = grid.cells().iter().map(occupancy).collect();
    of_cells((grid.width(), grid.height()), &occupancy)
}

fn of_cells(sides: (usize, usize), occupancy: &[u8]) -> DistanceField {
    let frame = GridFrame {
        resolution_m: 0.1,
        map_from_grid: Pose::IDENTITY,
    };
    DistanceField::new(frame, sides, occupancy, CellRules::default()).expect("drawings are maps")
}
