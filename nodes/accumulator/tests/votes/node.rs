//! Tests of the node as a process: its votes are compared with those of the engine.

use engine::beams::BeamConfig;
use engine::vote_search::{Outcome, Prior};
use messages::{
    BoundaryCell, Corner, FieldHeader, FieldKind, NodeState, RegionHeader, SearchOutcome, Stamp,
    Vote, VotesHeader, topic,
};
use transport::Publisher;
use transport::testing::{Isolated, wait_for_health, wait_for_next};

use tests::drawn_room::{FRAME, MOUNT, ROOM, map_header, occupancy, ranges, scan};

use crate::world::{World, id, vote_search};

/// The same room with the pillar moved and a door opened.
pub(crate) const CHANGED: [&str; 9] = [
    "################",
    "#..............#",
    "#...##.........#",
    "#..............#",
    "#..............#",
    "#.....####..####",
    "#.....#.........",
    "#.....#.........",
    "#######.........",
];

/// Three blocks of sixteen cells long and two high; the outer ones are cut off.
const HALL: [&str; 18] = [
    "########################################",
    "#......................................#",
    "#......................................#",
    "#............##........................#",
    "#............##...............#........#",
    "#......................................#",
    "#......................................#",
    "#......................................#",
    "###########.......##############.......#",
    "..........#.......#............#.......#",
    "..........#.......#............#.......#",
    "..........#.......#............#.......#",
    "..........#.......#............#..#....#",
    "..........#.......#............#.......#",
    "..........#.......#............#.......#",
    "..........#..#....#............#.......#",
    "..........#.......#............#.......#",
    "..........#########............#########",
];

fn searched(rows: &[&str], ranges: &[f32]) -> Outcome {
    let outcome = vote_search(rows, Prior::None).search(&scan(ranges), &|| false);
    outcome.unwrap().unwrap()
}

#[track_caller]
fn assert_equals(votes: &VotesHeader, poses: &[Vote], outcome: &Outcome) {
    let found = &outcome.found;
    assert_eq!(poses, found.votes);
    let expected = VotesHeader {
        total: poses.len() as u64,
        outcome: SearchOutcome::Found as u32,
        headings: outcome.headings,
        floor: found.floor.into(),
        certified_floor: found.certified_floor.into(),
        best: found.best.into(),
        highest_possible: outcome.highest_possible,
        truncated: found.truncated.into(),
        beams_used: outcome.beams_used,
        beams_silent: outcome.beams_silent,
        heading_known: 0,
        known_heading: 0.0,
        bearing_rounding: outcome.bearing_rounding,
        base_from_laser: MOUNT,
        mount_known: 1,
        max_beams: 180,
        pooling: 1,
        beam_arc_m: BeamConfig::default().beam_arc_m,
        ..*votes
    };
    assert_eq!(*votes, expected);
}

fn is_refused(votes: &VotesHeader) -> bool {
    votes.outcome == SearchOutcome::Refused as u32
}

#[test]
fn votes_are_those_of_the_engine() {
    let isolated = Isolated::new("equal");
    let world = World::new(&isolated);
    // Both are published before the node starts, so the node is a late joiner.
    world.publish(&ROOM);
    let node = world.start(&[]);
    world.wait_until(NodeState::Ready);
    for (x, y, heading) in [(3, 3, 40), (12, 6, 211), (9, 4, 0)] {
        let ranges = ranges(&ROOM, x, y, heading);
        let (votes, poses) = world.ask(&ranges);
        let outcome = searched(&ROOM, &ranges);
        assert_equals(&votes, &poses, &outcome);
        assert_eq!(votes.map_id, id(&ROOM));
        assert!(votes.engine_ns > 0 && votes.poses_evaluated > 0);
        let best = poses[0];
        let found = (i64::from(best.x), i64::from(best.y), best.heading.into());
        assert_eq!(found, (x, y, heading));
    }
    node.stop();
    let (last, error) = world.wait_until(NodeState::Stopped);
    let counts = (last.received, last.sent, last.dropped, last.refused);
    assert_eq!(counts, (5, 3, 0, 0), "a map, a boundary and three scans");
    assert_eq!(error, "");
}

#[test]
fn the_image_bounds_the_votes_where_the_heading_is_searched() {
    let isolated = Isolated::new("bounds");
    let world = World::new(&isolated);
    let node = world.start_on(&HALL, &["--field-rate", "0.1"]);
    let fields = world.graph.subscriber::<topic::Field>().unwrap();
    let ranges = ranges(&HALL, 35, 4, 211);
    let (votes, poses) = world.ask(&ranges);
    let (header, bounds) = wait_for_next(&world.graph, &fields);

    let expected = FieldHeader {
        stamp: votes.stamp,
        map_id: id(&HALL),
        width: 3,
        height: 2,
        block: 16,
        kind: FieldKind::UpperBound as u32,
        best: bounds.iter().copied().max().unwrap().into(),
        highest_possible: votes.highest_possible,
        heading: 0.0,
    };
    assert_eq!((header, bounds.len()), (expected, 6));
    assert!(header.best <= header.highest_possible);
    assert_eq!(poses.first().map(|best| (best.x, best.y)), Some((35, 4)));
    for vote in poses {
        let (x, y) = (u32::from(vote.x), u32::from(vote.y));
        let pixel = y / header.block * header.width + x / header.block;
        assert!(vote.intensity <= bounds[pixel as usize], "{vote:?}");
    }

    world.assert_no_image_yet(&fields, &ranges);
    node.stop();
}

#[test]
fn bad_scans_are_refused_and_counted_and_the_next_good_one_is_answered() {
    let isolated = Isolated::new("bad");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.wait_until(NodeState::Waiting);
    let good = ranges(&ROOM, 3, 3, 40);

    let (votes, poses) = world.ask(&good);
    assert!(is_refused(&votes) && poses.is_empty());
    assert_eq!(votes.map_id, 0);
    let error = world.wait_for_refused(1);
    assert_eq!(error, "scan 0 rejected: there is no map yet");

    world.publish(&ROOM);
    world.wait_until(NodeState::Ready);
    let bad = [
        world.ask(&[]),
        world.ask_with(&good, |scan| scan.angle_increment = 0.0),
        world.ask_with(&good, |scan| scan.angle_min = f64::NAN),
        world.ask_with(&good, |scan| scan.base_from_laser.x = f64::INFINITY),
    ];
    for (votes, poses) in bad {
        assert!(is_refused(&votes) && poses.is_empty());
        assert_eq!(votes.map_id, id(&ROOM));
    }
    let error = world.wait_for_refused(5);
    let expected = "scan 4 rejected: the laser sits at x inf m";
    assert!(error.starts_with(expected), "{error}");

    let (votes, poses) = world.ask(&good);
    assert_equals(&votes, &poses, &searched(&ROOM, &good));
    let (votes, poses) = world.ask(&[f32::INFINITY, f32::NAN, -1.0, 0.0]);
    assert_eq!(votes.outcome, SearchOutcome::NoVotes as u32);
    assert_eq!((poses.len(), votes.beams_silent), (0, 4));
    node.stop();
    let (last, _) = world.wait_until(NodeState::Stopped);
    assert_eq!((last.refused, last.sent), (5, 7));
}

#[test]
fn scans_that_never_came_are_counted_as_dropped() {
    let isolated = Isolated::new("dropped");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.wait_until(NodeState::Waiting);
    world.counter.set(7);
    world.ask(&[1.0]);
    world.counter.set(12);
    world.ask(&[1.0]);
    wait_for_health(&world.graph, &world.health, |report| report.dropped == 4);
    node.stop();
}

/// Asks until a scan is matched with `map_id`; each answer must be that of the map it names.
fn ask_until_swapped(world: &World, map_id: u64) {
    let scanned = ranges(&CHANGED, 3, 3, 40);
    loop {
        let (votes, poses) = world.ask(&scanned);
        let rows = match votes.map_id == id(&ROOM) {
            true => &ROOM,
            false => &CHANGED,
        };
        assert_equals(&votes, &poses, &searched(rows, &scanned));
        if votes.map_id == map_id {
            return;
        }
        assert_eq!(votes.map_id, id(&ROOM));
    }
}

#[test]
fn a_new_map_is_used_once_it_and_its_boundary_are_there() {
    let isolated = Isolated::new("swap");
    let world = World::new(&isolated);
    let node = world.start(&[]);
    world.publish_boundary(id(&ROOM), &ROOM);
    world.publish_map(&ROOM);
    world.wait_until(NodeState::Ready);

    world.publish_map(&CHANGED);
    let (votes, _) = world.ask(&ranges(&ROOM, 3, 3, 40));
    // The boundary of the new map is missing.
    assert_eq!(votes.map_id, id(&ROOM));
    world.publish_boundary(id(&CHANGED), &CHANGED);
    ask_until_swapped(&world, id(&CHANGED));
    node.stop();
}

#[test]
fn a_map_that_is_refused_leaves_the_one_before_in_use() {
    let isolated = Isolated::new("refuse");
    let world = World::new(&isolated);
    let node = world.start_on(&ROOM, &[]);

    // A wrong id would let data of one map be used for another one.
    let other_cells = occupancy(&CHANGED);
    world.maps.send(map_header(&ROOM), &other_cells).unwrap();
    let (report, error) = world.wait_until(NodeState::Degraded);
    assert_eq!(report.refused, 1);
    assert!(error.contains("is not that of its cells"), "{error}");

    world.publish_map(&CHANGED);
    let mut loan = world.boundaries.loan(1).unwrap();
    loan.header_mut().map_id = id(&CHANGED);
    loan.header_mut().boundary_cells = 1;
    loan.items_mut()[0] = BoundaryCell { x: 999, y: 0 };
    loan.send().unwrap();
    let error = world.wait_for_refused(2);
    let expected = format!(
        "map {:016x} rejected: cell 999, 0 of the boundary is not an occupied cell of the map",
        id(&CHANGED)
    );
    assert_eq!(error, expected);
    let (votes, _) = world.ask(&ranges(&ROOM, 3, 3, 40));
    assert_eq!(votes.map_id, id(&ROOM));

    // The restarted extractor sends a valid boundary.
    world.publish_boundary(id(&CHANGED), &CHANGED);
    world.wait_until(NodeState::Ready);
    ask_until_swapped(&world, id(&CHANGED));
    node.stop();
}

#[test]
fn a_map_that_is_taken_back_is_in_use_again() {
    let isolated = Isolated::new("back");
    let world = World::new(&isolated);
    let node = world.start_on(&ROOM, &[]);
    world.publish_map(&["####", "####"]);
    world.publish_boundary(id(&["####", "####"]), &["####", "#..#", "####"]);
    world.wait_until(NodeState::Degraded);
    world.publish(&ROOM);
    world.wait_until(NodeState::Ready);
    let (votes, _) = world.ask(&ranges(&ROOM, 3, 3, 40));
    assert_eq!(votes.map_id, id(&ROOM));
    node.stop();
}

pub(crate) fn request(regions: &Publisher<topic::Region>, corners: &[(f64, f64)]) {
    let corner = |&(x, y): &(f64, f64)| {
        let side = FRAME.resolution_m;
        let (x, y) = FRAME.map_from_grid.transform(x * side, y * side);
        Corner { x, y }
    };
    let corners: Vec<Corner> = corners.iter().map(corner).collect();
    let stamp = Stamp::default();
    regions.send(RegionHeader { stamp }, &corners).unwrap();
}

#[test]
fn a_requested_region_holds_until_it_is_taken_back() {
    let isolated = Isolated::new("region");
    let world = World::new(&isolated);
    let regions = world.graph.publisher::<topic::Region>().unwrap();
    let node = world.start_on(&ROOM, &[]);
    let ranges = ranges(&ROOM, 12, 6, 211);
    let found = || world.ask(&ranges).1[0].x;
    assert_eq!(found(), 12);
    // Scans are answered with the old map until the new one is prepared.
    request(&regions, &[(0.0, 0.0), (6.0, 0.0), (6.0, 9.0), (0.0, 9.0)]);
    while found() >= 6 {}
    // An invalid region changes nothing.
    request(&regions, &[(0.0, 0.0), (f64::NAN, 1.0)]);
    let error = world.wait_for_refused(1);
    let expected = "search region rejected: a corner at NaN";
    assert!(error.contains(expected), "{error}");
    assert!(found() < 6);
    request(&regions, &[]);
    while found() != 12 {}
    node.stop();
}
