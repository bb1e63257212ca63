//! Distance fields drawn as text for tests: `#` is occupied, `?` unknown, other characters free.
//! The last line is the lowest row; cells have sides of 0.1 m.

use engine::fit::DistanceField;
use engine::grid::{CellRules, GridFrame};
use geometry::Pose;
use messages::UNKNOWN;

pub(super) fn distance_field(rows: &[&str]) -> DistanceField {
    let from_below = rows.iter().rev().flat_map(|row| row.bytes());
    let cell = |cell| match cell {
        b'#' => 100,
        b'?' => UNKNOWN,
        _ => 0,
    };
    let occupancy: Vec<u8> = from_below.map(cell).collect();
    let frame = GridFrame {
        resolution_m: 0.1,
        map_from_grid: Pose::IDENTITY,
    };
    let sides = (rows[0].len(), rows.len());
    DistanceField::new(frame, sides, &occupancy, CellRules::default()).expect("drawings are maps")
}
