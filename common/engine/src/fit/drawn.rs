//! Distance fields drawn as text for tests: `#` is occupied, `?` unknown, the rest
//! free. The last line is the lowest row; cells have sides of 0.1 m.

use geometry::Pose;
use messages::UNKNOWN;

use super::DistanceField;
use crate::grid::{CellRules, GridFrame};

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
    let frame = GridFrame {
        resolution_m: 0.1,
        map_from_grid: Pose::IDENTITY,
    };
    DistanceField::new(
        frame,
        (rows[0].len(), rows.len()),
        &occupancy,
        CellRules::default(),
    )
    .expect("drawings are maps")
}
