//! Tests of the node as a process: votes go in, hypotheses come out.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::cell::Cell;

use bytemuck::Zeroable;
use engine::beams::BeamConfig;
use engine::fit::{BeamClass, DistanceField, Ends};
use engine::grid::{CellRules, GridFrame};
use engine::peaks::{self, PeakConfig, PeakInput, Places};
use engine::space::Space;
use engine::vote_search::{Outcome, Prior, VoteSearch, VoteSearchConfig};
use geometry::Pose;
use messages::{
    BeamFate, HealthHeader, HypothesesHeader, Hypothesis, MapHeader, NodeState, Pose2, ScanHeader,
    SearchOutcome, Verdict, Vote, VotesHeader, topic,
};
use tests::drawn_room::{FRAME, MOUNT, ROOM, grid, map_header, occupancy, ranges, scan};
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_for_next, wait_for_state};
use transport::{Graph, Publisher, Subscriber, stamp_now};

struct Searched {
    ranges: Vec<f32>,
    outcome: Outcome,
}

fn searched(x: i64, y: i64, heading: usize) -> Searched {
    let ranges = ranges(&ROOM, x, y, heading);
    let config = VoteSearchConfig::default();
    let vote_search = VoteSearch::new(FRAME, grid(&ROOM), config, Prior::None).unwrap();
    let outcome = vote_search.search(&scan(&ranges), &|| false);
    Searched {
        outcome: outcome.unwrap().unwrap(),
        ranges,
    }
}

fn expected(searched: &Searched, frame: GridFrame) -> Places {
    let distance_field =
        DistanceField::new(frame, (16, 9), &occupancy(&ROOM), CellRules::default()).unwrap();
    let space = Space::new(360, frame.resolution_m, 16, 9).unwrap();
    let (scan, beams) = (scan(&searched.ranges), BeamConfig::default());
    let find = |ends: &mut Ends| ends.find(&scan, &space, &beams);
    let input = PeakInput::of(&searched.outcome, frame);
    let mut workspace = peaks::Workspace::default();
    let judged = workspace.judge(&input, &distance_field, &PeakConfig::default(), find);
    judged.unwrap().places.clone()
}

struct World {
    graph: Graph,
    maps: Publisher<topic::Map>,
    scans: Publisher<topic::Scan>,
    votes: Publisher<topic::Votes>,
    hypotheses: Subscriber<topic::Hypotheses>,
    beams: Subscriber<topic::Beams>,
    health: Subscriber<topic::Health>,
    counter: Cell<u64>,
}

impl World {
    fn new(isolated: &Isolated) -> Self {
        let graph = isolated.join("test");
        World {
            maps: graph.publisher().unwrap(),
            scans: graph.publisher().unwrap(),
            votes: graph.publisher().unwrap(),
            hypotheses: graph.subscriber().unwrap(),
            beams: graph.subscriber().unwrap(),
            health: graph.subscriber().unwrap(),
            counter: Cell::new(0),
            graph,
        }
    }

    fn start(&self, arguments: &[&str]) -> NodeProcess {
        NodeProcess::start(env!("CARGO_BIN_EXE_peak_extractor"), &self.graph, arguments)
    }

    fn publish_map(&self, resolution_m: f64) {
        self.maps
            .send(map_at(resolution_m), &occupancy(&ROOM))
            .unwrap();
    }

    /// Publishes a scan and its votes and waits for the hypotheses of these votes.
    fn ask(
        &self,
        header: VotesHeader,
        ranges: &[f32],
        votes: &[Vote],
    ) -> (HypothesesHeader, Vec<Hypothesis>) {
        let counter = self.counter.replace(self.counter.get() + 1);
        let stamp = stamp_now(17, counter);
        let scan = scan(ranges);
        let scan_header = ScanHeader {
            stamp,
            angle_min: scan.angle_min,
            angle_increment: scan.angle_increment,
            range_max_m: scan.range_max_m,
            ..Zeroable::zeroed()
        };
        self.scans.send(scan_header, ranges).unwrap();
        self.votes
            .send(VotesHeader { stamp, ..header }, votes)
            .unwrap();
        let answer = wait_for_next(&self.graph, &self.hypotheses);
        assert_eq!(answer.0.stamp, stamp);
        assert!(answer.0.sent_ns >= stamp.entered_ns);
        answer
    }

    fn wait_until(&self, state: NodeState) {
        wait_for_state(&self.graph, &self.health, state);
    }
}

fn map_at(resolution_m: f64) -> MapHeader {
    let mut header = MapHeader {
        resolution_m,
        ..map_header(&ROOM)
    };
    header.map_id = header.id_of(&occupancy(&ROOM));
    header
}

fn id() -> u64 {
    map_header(&ROOM).map_id
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
        max_beams: 180,
        pooling: 1,
        beam_arc_m: 0.2,
        ..Zeroable::zeroed()
    }
}

#[test]
fn particles_lie_around_the_places_of_the_base() {
    let isolated = Isolated::new("particles");
    let world = World::new(&isolated);
    let particles: Subscriber<topic::Particles> = world.graph.subscriber().unwrap();
    world.publish_map(FRAME.resolution_m);
    let node = world.start(&["--particles", "30"]);
    world.wait_until(NodeState::Ready);
    let Searched { ranges, outcome } = searched(3, 3, 40);
    let (said, hypotheses) = world.ask(header(id(), &outcome), &ranges, &outcome.found.votes);
    assert_eq!(said.verdict, Verdict::Unique as u32);
    let best = Pose::from(hypotheses[0].map_from_base);
    let (start, drawn) = wait_for_next(&world.graph, &particles);
    assert_eq!((start.stamp, start.map_id), (said.stamp, id()));
    assert_eq!((start.mount_known, drawn.len()), (1, 30));
    for particle in drawn {
        // About half a cell and a degree of deviation around the single place, times five, with the
        // base rotating about the laser.
        let pose = Pose::from(particle.map_from_base);
        assert!(pose.is_within(best, 1.0, 0.2), "{pose:?} {best:?}");
    }
    node.stop();
}

#[test]
fn hypotheses_are_those_of_the_engine() {
    let isolated = Isolated::new("equal");
    let world = World::new(&isolated);
    world.publish_map(FRAME.resolution_m);
    let node = world.start(&[]);
    world.wait_until(NodeState::Ready);
    for (x, y, heading) in [(3, 3, 40), (12, 6, 211)] {
        let mut searched = searched(x, y, heading);
        // The last three beams have no return.
        searched.ranges[357..].fill(f32::INFINITY);
        let Searched { ranges, outcome } = &searched;
        let (said, hypotheses) = world.ask(header(id(), outcome), ranges, &outcome.found.votes);

        let expected = expected(&searched, FRAME);
        assert_eq!(said.verdict, expected.verdict as u32);
        assert_eq!(said.alternatives, expected.alternatives);
        assert_eq!((said.map_id, said.search_ns), (id(), 4321));
        let inlier_share = expected.inlier_share as f32;
        assert_eq!(said.best, u32::from(outcome.found.best));
        assert_eq!(said.inlier_share, inlier_share);
        assert_eq!(said.confidence, expected.confidence as f32);
        assert!(said.extract_ns > 0);
        assert_eq!(hypotheses.len(), expected.places.len());
        for (hypothesis, place) in hypotheses.iter().zip(&expected.places) {
            assert_eq!(hypothesis.map_from_laser, Pose2::from(place.map_from_laser));
            assert_eq!(hypothesis.covariance, place.covariance.to_rows());
            assert_eq!(hypothesis.support, place.support);
            let base = Pose::from(hypothesis.map_from_base);
            // Equal up to a few rounding errors of numbers below ten.
            let laser = base.then(MOUNT.into());
            assert!(laser.is_within(place.map_from_laser, 1e-12, 1e-12));
        }

        let (header, beams) = wait_for_next(&world.graph, &world.beams);
        assert_eq!((header.stamp, header.map_id), (said.stamp, id()));
        assert_eq!(header.map_from_laser, hypotheses[0].map_from_laser);
        let count = |fate: BeamFate| beams.iter().filter(|beam| beam.fate == fate as u32).count();
        // A sector of two beams has one vote.
        assert_eq!((beams.len(), count(BeamFate::NoReturn)), (180, 1));
        let classes = expected.classes.iter();
        let hits = classes.filter(|&&class| class == BeamClass::Hit);
        assert_eq!(count(BeamFate::Hit), hits.count());
        let beams = beams
            .iter()
            .map(|b| (b.range_m == f32::INFINITY, b.bearing));
        assert!(beams.is_sorted());
    }
    node.stop();
}

#[test]
fn votes_that_cannot_be_read_are_refused_and_the_next_ones_answered() {
    let isolated = Isolated::new("refused");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.wait_until(NodeState::Waiting);
    let Searched { ranges, outcome } = &searched(3, 3, 40);
    let (votes, sound) = (&outcome.found.votes, header(id(), outcome));
    let refused = |(said, hypotheses): (HypothesesHeader, Vec<Hypothesis>), count: u64| {
        assert_eq!(said.verdict, Verdict::NoScan as u32);
        assert!(hypotheses.is_empty());
        let is_it = |report: &HealthHeader| report.refused == count;
        wait_for_health(&world.graph, &world.health, is_it).1
    };
    let error = refused(world.ask(sound, ranges, votes), 1);
    let unknown = format!("votes of scan 0 rejected: they are of map {:016x}", id());
    assert!(error.starts_with(&unknown), "{error}");
    world.publish_map(FRAME.resolution_m);
    world.wait_until(NodeState::Ready);
    let broken = VotesHeader {
        headings: 0,
        ..sound
    };
    let error = refused(world.ask(broken, ranges, votes), 2);
    assert!(error.contains("headings is 0"), "{error}");
    let mut off_the_map = votes.clone();
    off_the_map[0].x = 16;
    let error = refused(world.ask(sound, ranges, &off_the_map), 3);
    assert!(error.contains("vote 0 is for cell 16"), "{error}");

    let (said, hypotheses) = world.ask(sound, ranges, votes);
    assert_eq!(said.verdict, Verdict::Unique as u32);
    assert!(!hypotheses.is_empty());
    node.stop();
    let (last, _) = wait_for_state(&world.graph, &world.health, NodeState::Stopped);
    let counts = (last.received, last.sent, last.dropped, last.refused);
    assert_eq!(counts, (9, 4, 0, 3), "a map, four scans and their votes");
}

#[test]
fn votes_on_their_way_when_the_map_changes_are_of_the_map_before() {
    let isolated = Isolated::new("swap");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.publish_map(FRAME.resolution_m);
    world.wait_until(NodeState::Ready);
    // A rejected map does not replace another one.
    world.publish_map(-1.0);
    world.wait_until(NodeState::Degraded);
    world.publish_map(2.0 * FRAME.resolution_m);
    world.wait_until(NodeState::Ready);

    let searched = searched(3, 3, 40);
    let Searched { ranges, outcome } = &searched;
    for scale in [1.0, 2.0] {
        let map_id = map_at(scale * FRAME.resolution_m).map_id;
        let header = header(map_id, outcome);
        let (_, hypotheses) = world.ask(header, ranges, &outcome.found.votes);
        let frame = GridFrame {
            resolution_m: scale * FRAME.resolution_m,
            ..FRAME
        };
        let expected = Pose2::from(expected(&searched, frame).places[0].map_from_laser);
        assert_eq!(
            hypotheses[0].map_from_laser, expected,
            "cells times {scale}"
        );
    }
    node.stop();
}
