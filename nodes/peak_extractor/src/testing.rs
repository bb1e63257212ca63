//! A drawn room, a scan in it, and votes on it, for tests.

use bytemuck::Zeroable;
use messages::{MapHeader, ScanHeader, SearchOutcome, Stamp, Vote, VotesHeader};

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

pub(crate) fn room() -> MapHeader {
    MapHeader {
        width: 30,
        height: 20,
        resolution_m: 1.0,
        ..MapHeader::default()
    }
}

pub(crate) fn cells() -> Vec<u8> {
    let cells = ROOM.iter().rev().flat_map(|row| row.bytes());
    cells.map(|cell| 100 * u8::from(cell == b'#')).collect()
}

pub(crate) fn vote(x: u16, y: u16, heading: u16, intensity: u16) -> Vote {
    Vote {
        x,
        y,
        heading,
        intensity,
    }
}

/// Returns the header of votes on map 7, the best of which has intensity 100.
pub(crate) fn votes_header() -> VotesHeader {
    VotesHeader {
        stamp: Stamp {
            measured_ns: 1,
            entered_ns: 2,
            counter: 3,
        },
        map_id: 7,
        outcome: SearchOutcome::Found as u32,
        headings: 360,
        certified_floor: 50,
        best: 100,
        highest_possible: 125,
        max_beams: 180,
        pooling: 1,
        beam_arc_m: 0.2,
        ..Zeroable::zeroed()
    }
}

/// Scan from the middle of cell (10, 5) at heading 0 of the grid, with a beam per degree.
pub(crate) fn scans(stamp: Stamp) -> Scans {
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
