//! Distance fields drawn as text for tests: `#` is occupied, `?` unknown, `.` free. The last
//! line is the lowest row; cells have sides of 0.1 m.

use geometry::Pose;

use super::DistanceField;
use crate::grid::{CellRules, Grid, GridFrame, drawn};
use crate::testing::occupancy_of;

pub(crate) fn distance_field(rows: &[&str]) -> DistanceField {
    let (width, height, occupancy) = drawn::occupancy(rows);
    of_cells((width, height), &occupancy)
}

/// Distance field of a grid.
pub(crate) fn field_of(grid: &Grid) -> DistanceField {
    of_cells((grid.width(), grid.height()), &occupancy_of(grid))
}

fn of_cells(sides: (usize, usize), occupancy: &[u8]) -> DistanceField {
    let frame = GridFrame::new(0.1, Pose::IDENTITY);
    DistanceField::new(frame, sides, occupancy, CellRules::default()).expect("drawings are maps")
}
