//! Drawn world and the node's neighbours.

use std::cell::Cell;

use bytemuck::Zeroable;
use engine::boundary;
use engine::vote_search::{Prior, VoteSearch, VoteSearchConfig};
use messages::{
    BoundaryHeader, FrameName, HealthHeader, NodeState, ScanHeader, Vote, VotesHeader, topic,
};
use tests::drawn_room::{FRAME, MOUNT, grid, map_header, occupancy, scan};
use transport::{Graph, Publisher, Subscriber, stamp_now};

use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_for_next, wait_for_state};

pub(crate) fn id(rows: &[&str]) -> u64 {
    map_header(rows).map_id
}

pub(crate) fn vote_search(rows: &[&str], prior: Prior) -> VoteSearch {
    let grid = grid(rows);
    VoteSearch::new(FRAME, grid, VoteSearchConfig::default(), prior).unwrap()
}

pub(crate) struct World {
    pub(crate) graph: Graph,
    pub(crate) maps: Publisher<topic::Map>,
    pub(crate) boundaries: Publisher<topic::Boundary>,
    pub(crate) scans: Publisher<topic::Scan>,
    pub(crate) votes: Subscriber<topic::Votes>,
    pub(crate) health: Subscriber<topic::Health>,
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

    /// Starts the node and waits until it can search the drawing.
    pub(crate) fn start_on(&self, rows: &[&str], arguments: &[&str]) -> NodeProcess {
        let node = self.start(arguments);
        self.publish(rows);
        self.wait_until(NodeState::Ready);
        node
    }

    pub(crate) fn publish(&self, rows: &[&str]) {
        self.publish_map(rows);
        self.publish_boundary(id(rows), rows);
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

    pub(crate) fn ask_with(
        &self,
        ranges: &[f32],
        change: impl FnOnce(&mut ScanHeader),
    ) -> (VotesHeader, Vec<Vote>) {
        let counter = self.counter.replace(self.counter.get() + 1);
        let plain = scan(&[]);
        let mut header = ScanHeader {
            stamp: stamp_now(1_000_000_000 * counter as i64, counter),
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

    /// Asserts that the next image, due in ten seconds, is not sent: it would be, before the answer.
    pub(crate) fn assert_no_image_yet(&self, fields: &Subscriber<topic::Field>, ranges: &[f32]) {
        for _ in 0..3 {
            self.ask(ranges);
        }
        assert!(fields.receive().unwrap().is_none());
    }

    /// Waits until the node has refused this many messages; returns the last reason.
    pub(crate) fn wait_for_refused(&self, count: u64) -> String {
        let is_it = |report: &HealthHeader| report.refused == count;
        wait_for_health(&self.graph, &self.health, is_it).1
    }

    pub(crate) fn wait_until(&self, state: NodeState) -> (HealthHeader, String) {
        wait_for_state(&self.graph, &self.health, state)
    }
}
