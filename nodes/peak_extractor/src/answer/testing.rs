//! A drawn room and a scan in it, for tests.

use bytemuck::Zeroable;
use messages::{MapHeader, ScanHeader, Stamp};

use crate::scans::Scans;

/// Cells of one metre; the last line is the lowest row.
const ROOM: [&str; 20] = [
    "##############################",
    "########.....................#",
    "########.....................#",
    "########.....................#",
    "########.....................#",
    "########.....................#",
    "########.....................#",
    "########.....................#",
    "#............................#",
    "#.............##.............#",
    "#.............##.............#",
    "#............................#",
    "#............................#",
    "#............................#",
    "#............................#",
    "#............................#",
    "#....................#########",
    "#....................#########",
    "#....................#########",
    "##############################",
];

pub(super) fn room() -> MapHeader {
    MapHeader {
        width: 30,
        height: 20,
        resolution_m: 1.0,
        ..MapHeader::default()
    }
}

pub(super) fn cells() -> Vec<u8> {
    let cells = ROOM.iter().rev().flat_map(|row| row.bytes());
    cells.map(|cell| 100 * u8::from(cell == b'#')).collect()
}

/// Scan from the middle of cell (10, 5) at heading 0 of the grid, with a beam per degree.
pub(super) fn scans(stamp: Stamp) -> Scans {
    let cells = cells();
    let is_free = |x: f64, y: f64| cells[30 * y as usize + x as usize] == 0;
    let range = |degrees: u32| {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let steps = (0..).map(|step| 0.01 * f64::from(step));
        let free = steps.take_while(|r| is_free(10.5 + r * cos, 5.5 + r * sin));
        free.last().unwrap() as f32 + 0.5
    };
    let ranges: Vec<f32> = (0..360).map(range).collect();
    let header = ScanHeader {
        stamp,
        angle_increment: 1f64.to_radians(),
        range_max_m: 50.0,
        ..Zeroable::zeroed()
    };
    let mut scans = Scans::default();
    scans.receive(&header, &ranges);
    scans
}
