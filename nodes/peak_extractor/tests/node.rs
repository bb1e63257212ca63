//! The node as a process: votes go in, hypotheses come out.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::cell::Cell;
use std::f64::consts::PI;

use bytemuck::Zeroable;
use engine::boundary;
use engine::grid::{CellRules, Grid, GridFrame};
use engine::localizer::{Localizer, LocalizerConfig, Outcome, Prior};
use engine::peaks::{PeakConfig, PeakInput, extract};
use engine::reference;
use engine::scan::Scan;
use engine::space::Space;
use geometry::Pose;
use messages::{
    HypothesesHeader, Hypothesis, MapHeader, NodeState, Pose2, SearchOutcome, Stamp, Verdict, Vote,
    VotesHeader, topic,
};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_for_health};
use transport::{Graph, Publisher, Subscriber, monotonic_ns};

/// A room with a pillar: no pose in it looks like another.
const ROOM: [&str; 9] = [
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
const FRAME: GridFrame = GridFrame {
    resolution_m: 0.25,
    map_from_grid: Pose::new(3.0, -1.0, 0.5),
};
const MOUNT: Pose2 = Pose2 {
    x: 0.78,
    y: 0.0,
    yaw: 0.125,
};

/// What the engine says about a scan of the room from the given pose.
fn searched(x: i64, y: i64, heading: usize) -> Outcome {
    let cells: Vec<u8> = ROOM
        .iter()
        .rev()
        .flat_map(|row| row.bytes())
        .map(|cell| 100 * u8::from(cell == b'#'))
        .collect();
    let grid = Grid::new(16, 9, &cells, CellRules::default()).unwrap();
    let space = Space::new(360, FRAME.resolution_m, 16, 9).unwrap();
    let beams = (0..360).map(|beam| {
        let direction = space.directions.get(heading + 180 + beam);
        reference::range(&grid, x, y, direction).map_or(f32::INFINITY, |steps| {
            (f64::from(steps) / direction.steps_per_cell * FRAME.resolution_m) as f32
        })
    });
    let ranges: Vec<f32> = beams.collect();
    let scan = Scan {
        angle_min: -PI,
        angle_increment: 1f64.to_radians(),
        range_min_m: 0.0,
        range_max_m: 30.0,
        ranges: &ranges,
    };
    let boundary = boundary::extract(&grid);
    let config = LocalizerConfig::default();
    let localizer = Localizer::new(FRAME, grid, &boundary, config, Prior::None).unwrap();
    localizer.search(&scan, &|| false).unwrap().unwrap()
}

/// The node's neighbours.
struct World {
    graph: Graph,
    maps: Publisher<topic::Map>,
    votes: Publisher<topic::Votes>,
    hypotheses: Subscriber<topic::Hypotheses>,
    health: Subscriber<topic::Health>,
    counter: Cell<u64>,
}

impl World {
    fn new(isolated: &Isolated) -> Self {
        let graph = isolated.join("test");
        World {
            maps: graph.publisher().unwrap(),
            votes: graph.publisher().unwrap(),
            hypotheses: graph.subscriber().unwrap(),
            health: graph.subscriber().unwrap(),
            counter: Cell::new(0),
            graph,
        }
    }

    fn start(&self, arguments: &[&str]) -> NodeProcess {
        NodeProcess::start(env!("CARGO_BIN_EXE_peak_extractor"), &self.graph, arguments)
    }

    fn publish_map(&self, map_id: u64, resolution_m: f64) {
        let mut loan = self.maps.loan(16 * 9).unwrap();
        *loan.header_mut() = MapHeader {
            map_id,
            width: 16,
            height: 9,
            resolution_m,
            map_from_grid: FRAME.map_from_grid.into(),
            ..Zeroable::zeroed()
        };
        loan.send().unwrap();
    }

    /// Sends votes and waits for the hypotheses; fails if those of other votes
    /// come.
    fn ask(&self, header: VotesHeader, votes: &[Vote]) -> (HypothesesHeader, Vec<Hypothesis>) {
        let counter = self.counter.replace(self.counter.get() + 1);
        let stamp = Stamp {
            measured_ns: 17,
            entered_ns: monotonic_ns(),
            counter,
        };
        let mut loan = self.votes.loan(votes.len()).unwrap();
        *loan.header_mut() = VotesHeader { stamp, ..header };
        loan.items_mut().copy_from_slice(votes);
        loan.send().unwrap();
        let answer = wait_for(&self.graph, &self.hypotheses, |header, items| {
            Some((*header, items.to_vec()))
        });
        assert_eq!(answer.0.stamp, stamp);
        assert!(answer.0.sent_ns >= stamp.entered_ns);
        answer
    }

    fn wait_until(&self, state: NodeState) {
        wait_for_health(&self.graph, &self.health, |report| {
            report.state == state as u32
        });
    }
}

fn header(map_id: u64, outcome: &Outcome) -> VotesHeader {
    VotesHeader {
        map_id,
        engine_ns: 4321,
        outcome: SearchOutcome::Found as u32,
        headings: outcome.headings,
        certified_floor: outcome.found.certified_floor.into(),
        best: outcome.found.best.into(),
        highest_possible: outcome.highest_possible,
        base_from_laser: MOUNT,
        mount_known: 1,
        ..Zeroable::zeroed()
    }
}

#[test]
fn hypotheses_are_those_of_the_engine() {
    let isolated = Isolated::new("equal");
    let world = World::new(&isolated);
    world.publish_map(5, FRAME.resolution_m);
    let node = world.start(&[]);
    world.wait_until(NodeState::Ready);
    for (x, y, heading) in [(3, 3, 40), (12, 6, 211)] {
        let outcome = searched(x, y, heading);
        let votes = &outcome.found.votes;
        let (said, hypotheses) = world.ask(header(5, &outcome), votes);

        let expected = extract(&PeakInput::of(&outcome, FRAME), &PeakConfig::default());
        assert_eq!(said.verdict, expected.verdict as u32);
        assert_eq!(said.alternatives, expected.alternatives);
        assert_eq!((said.map_id, said.search_ns), (5, 4321));
        assert_eq!(
            (said.best, said.inlier_share),
            (outcome.found.best.into(), 1.0)
        );
        assert!(said.extract_ns > 0);
        assert_eq!(hypotheses.len(), expected.places.len());
        for (hypothesis, place) in hypotheses.iter().zip(&expected.places) {
            assert_eq!(hypothesis.map_from_laser, Pose2::from(place.map_from_laser));
            assert_eq!(hypothesis.covariance, place.covariance.to_rows());
            assert_eq!(hypothesis.support, place.support);
            let base = Pose::from(hypothesis.map_from_base);
            // The mount there and back: a few roundings of numbers below ten.
            let laser = base.then(MOUNT.into());
            assert!(laser.is_within(place.map_from_laser, 1e-12, 1e-12));
        }
    }
    node.stop();
}

#[test]
fn votes_that_cannot_be_read_are_refused_and_the_next_ones_answered() {
    let isolated = Isolated::new("refused");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.wait_until(NodeState::Waiting);
    let outcome = searched(3, 3, 40);
    let (votes, sound) = (&outcome.found.votes, header(5, &outcome));
    let refused = |answer: (HypothesesHeader, Vec<Hypothesis>), count: u64| {
        assert_eq!(answer.0.verdict, Verdict::NoScan as u32);
        assert!(answer.1.is_empty());
        let (_, error) = wait_for_health(&world.graph, &world.health, |report| {
            report.refused == count
        });
        error
    };
    let error = refused(world.ask(sound, votes), 1);
    assert!(
        error.starts_with("the votes of scan 0 are refused: they are of map 0000000000000005"),
        "{error}"
    );
    world.publish_map(5, FRAME.resolution_m);
    world.wait_until(NodeState::Ready);
    let broken = VotesHeader {
        headings: 0,
        ..sound
    };
    let error = refused(world.ask(broken, votes), 2);
    assert!(error.contains("headings is 0"), "{error}");
    let mut off_the_map = votes.clone();
    off_the_map[0].x = 16;
    let error = refused(world.ask(sound, &off_the_map), 3);
    assert!(error.contains("vote 0 is for cell 16"), "{error}");

    // Neither is wrong with these: the scan alone said nothing.
    for outcome in [SearchOutcome::Refused, SearchOutcome::NoVotes] {
        let empty = VotesHeader {
            outcome: outcome as u32,
            best: 0,
            map_id: 0,
            ..sound
        };
        let (said, hypotheses) = world.ask(empty, &[]);
        assert_eq!(said.verdict, Verdict::NoScan as u32);
        assert!(hypotheses.is_empty());
    }
    let (said, hypotheses) = world.ask(sound, votes);
    assert_eq!(said.verdict, Verdict::Unique as u32);
    assert!(!hypotheses.is_empty());
    node.stop();
    let (last, _) = wait_for_health(&world.graph, &world.health, |report| {
        report.state == NodeState::Stopped as u32
    });
    let counts = (last.received, last.sent, last.dropped, last.refused);
    assert_eq!(counts, (7, 6, 0, 3), "a map and six messages of votes");
}

#[test]
fn votes_on_their_way_when_the_map_changes_are_of_the_map_before() {
    let isolated = Isolated::new("swap");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.publish_map(5, FRAME.resolution_m);
    world.wait_until(NodeState::Ready);
    // A map that is refused takes no place.
    world.publish_map(9, -1.0);
    world.wait_until(NodeState::Degraded);
    world.publish_map(6, 2.0 * FRAME.resolution_m);
    world.wait_until(NodeState::Ready);

    let outcome = searched(3, 3, 40);
    for (map_id, scale) in [(5, 1.0), (6, 2.0)] {
        let (_, hypotheses) = world.ask(header(map_id, &outcome), &outcome.found.votes);
        let frame = GridFrame {
            resolution_m: scale * FRAME.resolution_m,
            ..FRAME
        };
        let expected = extract(&PeakInput::of(&outcome, frame), &PeakConfig::default());
        let expected = Pose2::from(expected.places[0].map_from_laser);
        assert_eq!(hypotheses[0].map_from_laser, expected, "map {map_id}");
    }
    node.stop();
}
