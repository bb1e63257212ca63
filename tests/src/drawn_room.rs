//! A drawn room, its map as a message and in the engine's form, and scans in it.

use std::f64::consts::PI;

use engine::grid::{CellRules, Grid, GridFrame};
use engine::reference;
use engine::scan::Scan;
use engine::space::Space;
use geometry::Pose;
use messages::{MapHeader, Pose2};

/// A room with a pillar, in which no two poses look alike.
pub const ROOM: [&str; 9] = [
    "################",
    "#..............#",
    "#..............#",
    "#..........##..#",
    "#..............#",
    "#.....##########",
    "#.....#.........",
    "#..#..#.........",
    "#######.........",
];

/// Rotated, so that a confusion of grid and map frames would show.
pub const FRAME: GridFrame = GridFrame::new(0.25, Pose::new(3.0, -1.0, 0.5));

/// Pose of the laser on the robot.
pub const MOUNT: Pose2 = Pose2::new(0.78, 0.0, 0.125);

/// Returns the occupancy of a drawing in per cent, row by row from the lowest y.
pub fn occupancy(rows: &[&str]) -> Vec<u8> {
    let cells = rows.iter().rev().flat_map(|row| row.bytes());
    cells.map(|cell| 100 * u8::from(cell == b'#')).collect()
}

/// Returns the header of the map in this drawing, placed by [`FRAME`].
pub fn map_header(rows: &[&str]) -> MapHeader {
    let mut header = MapHeader {
        width: rows[0].len() as u32,
        height: rows.len() as u32,
        resolution_m: FRAME.resolution_m,
        map_from_grid: FRAME.map_from_grid.into(),
        ..MapHeader::default()
    };
    header.map_id = header.id_of(&occupancy(rows));
    header
}

/// Returns a drawing in the engine's form.
pub fn grid(rows: &[&str]) -> Grid {
    let cells = occupancy(rows);
    Grid::new(rows[0].len(), rows.len(), &cells, CellRules::default()).unwrap()
}

/// Returns the ranges of a laser with one beam per degree all around, at a cell and a heading in
/// degrees of the grid.
pub fn ranges(rows: &[&str], x: i64, y: i64, heading: usize) -> Vec<f32> {
    let grid = grid(rows);
    let space = Space::new(360, FRAME.resolution_m, grid.width(), grid.height()).unwrap();
    let beams = (0..360).map(|beam| {
        let direction = space.directions.get(heading + 180 + beam);
        reference::range(&grid, x, y, direction).map_or(f32::INFINITY, |steps| {
            (f64::from(steps) / direction.steps_per_cell * FRAME.resolution_m) as f32
        })
    });
    beams.collect()
}

pub fn scan(ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min: -PI,
        angle_increment: 1f64.to_radians(),
        range_min_m: 0.0,
        range_max_m: 30.0,
        ranges,
    }
}
