//! Terrains drawn as text for tests: `#` is occupied, `?` unknown, the rest
//! free. The last line is the lowest row; cells have sides of 0.1 m.

use geometry::Pose;
use messages::UNKNOWN;

use super::Terrain;
use crate::grid::{CellRules, GridFrame};

pub(crate) fn terrain(rows: &[&str]) -> Terrain {
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
    Terrain::new(
        frame,
        (rows[0].len(), rows.len()),
        &occupancy,
        CellRules::default(),
    )
    .expect("drawings are maps")
}
