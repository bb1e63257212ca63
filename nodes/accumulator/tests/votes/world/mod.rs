//! Drawn world and the node's neighbours: publishers of maps, boundaries and scans, and a
//! subscriber to the votes.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::cell::Cell;
use std::f64::consts::PI;

use bytemuck::Zeroable;
use engine::boundary;
use engine::grid::{CellRules, Grid, GridFrame};
use engine::localizer::{Localizer, LocalizerConfig, Prior};
use engine::reference;
use engine::scan::Scan;
use engine::space::Space;
use geometry::Pose;
use messages::{
    BoundaryHeader, FrameName, HealthHeader, MapHeader, NodeState, Pose2, ScanHeader, Stamp, Vote,
    VotesHeader, topic,
};
use transport::{Graph, Publisher, Subscriber, monotonic_ns};

use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_for_next};

/// A room with a pillar, in which no two poses look alike.
pub(crate) const ROOM: [&str; 9] = [
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
pub(crate) const FRAME: GridFrame = GridFrame {
    resolution_m: 0.25,
    map_from_grid: Pose::new(3.0, -1.0, 0.5),
};

pub(crate) const MOUNT: Pose2 = Pose2 {
    x: 0.78,
    y: 0.0,
    yaw: 0.125,
};

pub(crate) fn occupancy(rows: &[&str]) -> Vec<u8> {
    let cells = rows.iter().rev().flat_map(|row| row.bytes());
    cells.map(|cell| 100 * u8::from(cell == b'#')).collect()
}

/// Returns the header of the map in this drawing.
pub(crate) fn map_header(rows: &[&str]) -> MapHeader {
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

pub(crate) fn id(rows: &[&str]) -> u64 {
    map_header(rows).map_id
}

pub(crate) fn grid(rows: &[&str]) -> Grid {
    let cells = occupancy(rows);
    Grid::new(rows[0].len(), rows.len(), &cells, CellRules::default()).unwrap()
}

/// Returns the engine's localizer for comparison.
pub(crate) fn localizer(rows: &[&str], prior: Prior) -> Localizer {
    let grid = grid(rows);
    Localizer::new(FRAME, grid, LocalizerConfig::default(), prior).unwrap()
}

/// Returns the ranges of a laser with one beam per degree all around, at a pose of the grid.
pub(crate) fn ranges(rows: &[&str], x: i64, y: i64, heading: usize) -> Vec<f32> {
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

/// Returns the scan of [`World::ask`] in the engine's type.
pub(crate) fn scan(ranges: &[f32]) -> Scan<'_> {
    Scan {
        angle_min: -PI,
        angle_increment: 1f64.to_radians(),
        range_min_m: 0.0,
        range_max_m: 30.0,
        ranges,
    }
}

/// Neighbours of the node.
pub(crate) struct World {
    pub(crate) graph: Graph,
    pub(crate) maps: Publisher<topic::Map>,
    pub(crate) boundaries: Publisher<topic::Boundary>,
    pub(crate) scans: Publisher<topic::Scan>,
    pub(crate) votes: Subscriber<topic::Votes>,
    pub(crate) health: Subscriber<topic::Health>,
    /// Counter of the next scan.
    pub(crate) counter: Cell<u64>,
}

impl World {
    pub(crate) fn new(isolated: &Isolated) -> Self {
        let graph = isolated.join("test");
        World {
            maps: graph.publisher().unwrap(),
            boundaries: graph.publisher().unwrap(),
            scans: graph.publisher().unwrap(),
            votes: graph.subscriber().unwrap(),
            health: graph.subscriber().unwrap(),
            counter: Cell::new(0),
            graph,
        }
    }

    pub(crate) fn start(&self, arguments: &[&str]) -> NodeProcess {
        NodeProcess::start(env!("CARGO_BIN_EXE_accumulator"), &self.graph, arguments)
    }

    pub(crate) fn publish_map(&self, rows: &[&str]) {
        let cells = occupancy(rows);
        self.maps.send(map_header(rows), &cells).unwrap();
    }

    pub(crate) fn publish_boundary(&self, map_id: u64, rows: &[&str]) {
        let grid = grid(rows);
        let cells = boundary::extract(&grid);
        let header = BoundaryHeader {
            map_id,
            free_cells: grid.free_cells() as u64,
            boundary_cells: cells.len() as u64,
            occupied_cells: grid.occupied_cells() as u64,
            ..Zeroable::zeroed()
        };
        self.boundaries.send(header, &cells).unwrap();
    }

    /// Publishes a scan and waits for its votes; fails if votes of another scan arrive.
    pub(crate) fn ask(&self, ranges: &[f32]) -> (VotesHeader, Vec<Vote>) {
        self.ask_with(ranges, |_| {})
    }

    /// Like [`World::ask`], with a header modified by `change`.
    pub(crate) fn ask_with(
        &self,
        ranges: &[f32],
        change: impl FnOnce(&mut ScanHeader),
    ) -> (VotesHeader, Vec<Vote>) {
        let counter = self.counter.replace(self.counter.get() + 1);
        let plain = scan(&[]);
        let mut header = ScanHeader {
            stamp: Stamp {
                measured_ns: 1_000_000_000 * counter as i64,
                entered_ns: monotonic_ns(),
                counter,
            },
            angle_min: plain.angle_min,
            angle_increment: plain.angle_increment,
            range_min_m: plain.range_min_m,
            range_max_m: plain.range_max_m,
            base_from_laser: MOUNT,
            mount_known: 1,
            frame: FrameName::new("laser"),
            ..Zeroable::zeroed()
        };
        change(&mut header);
        self.scans.send(header, ranges).unwrap();
        let answer = wait_for_next(&self.graph, &self.votes);
        assert_eq!(answer.0.stamp, header.stamp);
        answer
    }

    /// Waits until the node reports `state`.
    pub(crate) fn wait_until(&self, state: NodeState) -> (HealthHeader, String) {
        wait_for_health(&self.graph, &self.health, |report| {
            report.state == state as u32
        })
    }
}
