//! Tests of the node with a set of maps.

use std::time::{Duration, Instant};

use messages::{
    HealthHeader, MapHeader, MapName, MapSet, NodeState, Pose2, Stamp, Vote, VotesHeader, topic,
};
use transport::Publisher;
use transport::testing::{Isolated, NodeProcess, wait_for_health};

use crate::node::{CHANGED, request};
use tests::drawn_room::{FRAME, ROOM, map_header, occupancy, ranges};

use crate::world::{World, id};

/// Name of a map, offset of its frame along x in metres, and its drawing.
type Floor<'a> = (&'a str, f64, &'a [&'a str]);

const BUILDING: [Floor<'_>; 2] = [("ground", 0.0, &ROOM), ("first", 1000.0, &CHANGED)];

fn floor_header((name, along, rows): Floor<'_>) -> MapHeader {
    let mut header = MapHeader {
        name: MapName::new(name),
        map_from_grid: Pose2 {
            x: FRAME.map_from_grid.x + along,
            ..FRAME.map_from_grid.into()
        },
        ..map_header(rows)
    };
    header.map_id = header.id_of(&occupancy(rows));
    header
}

fn publish_set(
    sets: &Publisher<topic::Maps>,
    floors: &[Floor<'_>],
    change: impl Fn(&mut MapHeader),
) {
    let cells: Vec<_> = floors.iter().map(|floor| occupancy(floor.2)).collect();
    let maps = floors.iter().zip(&cells).map(|(&floor, cells)| {
        let mut header = floor_header(floor);
        change(&mut header);
        (header, &cells[..])
    });
    let set = MapSet {
        maps: maps.collect(),
        transitions: Vec::new(),
    };
    let mut loan = sets.loan(set.bytes()).unwrap();
    let header = set.write(Stamp::default(), loan.items_mut());
    *loan.header_mut() = header;
    loan.send().unwrap();
}

/// Asks for a scan of the room until the answer satisfies `is_it`.
#[track_caller]
fn ask_until(world: &World, is_it: impl Fn(&VotesHeader, &[Vote]) -> bool) {
    let (scanned, since) = (ranges(&ROOM, 12, 6, 211), Instant::now());
    loop {
        let (votes, poses) = world.ask(&scanned);
        if is_it(&votes, &poses) {
            return;
        }
        let is_late = since.elapsed() > Duration::from_secs(30);
        assert!(!is_late, "{votes:?} {:?}", poses.first());
    }
}

/// Returns true if both maps were searched and the room leads.
fn is_of_building(votes: &VotesHeader, poses: &[Vote]) -> bool {
    let best = poses.first().map(|best| (best.x, best.y));
    votes.maps == 2 && votes.map_id == floor_header(BUILDING[0]).map_id && best == Some((12, 6))
}

fn start(world: &World) -> (Publisher<topic::Maps>, NodeProcess) {
    let sets = world.graph.publisher().unwrap();
    publish_set(&sets, &BUILDING, |_| {});
    let node = world.start(&[]);
    world.wait_until(NodeState::Ready);
    (sets, node)
}

#[test]
fn a_map_that_is_served_alone_ends_the_set() {
    let isolated = Isolated::new("alone");
    let world = World::new(&isolated);
    let (sets, node) = start(&world);
    ask_until(&world, is_of_building);
    // This is the map of the set that is displayed.
    world.publish(&ROOM);
    for _ in 0..5 {
        ask_until(&world, is_of_building);
    }
    // The publisher of sets is gone, but the set stays in use until something else arrives.
    drop(sets);
    for _ in 0..5 {
        ask_until(&world, is_of_building);
    }
    world.publish(&CHANGED);
    ask_until(&world, |votes, _| {
        votes.maps == 0 && votes.map_id == id(&CHANGED)
    });
    node.stop();
}

#[test]
fn a_region_on_one_map_leaves_out_the_others() {
    let isolated = Isolated::new("one");
    let world = World::new(&isolated);
    let regions = world.graph.publisher::<topic::Region>().unwrap();
    let (sets, node) = start(&world);
    request(&regions, &[(0.0, 0.0), (6.0, 0.0), (6.0, 9.0), (0.0, 9.0)]);
    let ground = floor_header(BUILDING[0]).map_id;
    let is_within = |votes: &VotesHeader, poses: &[Vote]| {
        votes.maps == 0 && votes.map_id == ground && poses.iter().all(|vote| vote.x < 6)
    };
    ask_until(&world, is_within);

    // The region overlaps no map, so the previous one stays in force, also for later maps.
    request(&regions, &[(500.0, 500.0), (510.0, 510.0)]);
    let refused = |report: &HealthHeader| report.refused == 1;
    let (report, error) = wait_for_health(&world.graph, &world.health, refused);
    let expected = "search region rejected: no open cell of the map";
    assert!(error.starts_with(expected), "{error}");
    assert_eq!(report.state, NodeState::Ready as u32);
    let [ground_floor, first_floor] = BUILDING;
    publish_set(&sets, &[("hut", 0.0, &CHANGED), first_floor], |_| {});
    let hut = floor_header(("hut", 0.0, &CHANGED)).map_id;
    ask_until(&world, |votes, poses| {
        votes.map_id == hut && poses.iter().all(|vote| vote.x < 6)
    });
    publish_set(&sets, &[ground_floor, first_floor], |_| {});
    ask_until(&world, is_within);
    request(&regions, &[]);
    ask_until(&world, is_of_building);
    node.stop();
}

#[test]
fn a_set_that_is_refused_leaves_the_one_before_in_use() {
    let isolated = Isolated::new("rule");
    let world = World::new(&isolated);
    let regions = world.graph.publisher::<topic::Region>().unwrap();
    let (sets, node) = start(&world);
    publish_set(&sets, &BUILDING, |map| {
        map.occupied_from = match map.name.as_str() {
            "first" => 0,
            _ => map.occupied_from,
        };
    });
    let (_, error) = world.wait_until(NodeState::Degraded);
    let first = floor_header(BUILDING[1]).map_id;
    let expected = format!("map first ({first:016x}) rejected: occupied_from");
    assert!(error.starts_with(&expected), "{error}");
    ask_until(&world, is_of_building);
    request(&regions, &[(0.0, 0.0), (6.0, 0.0), (6.0, 9.0), (0.0, 9.0)]);
    ask_until(&world, |votes, poses| {
        votes.maps == 0 && poses.iter().all(|vote| vote.x < 6)
    });
    node.stop();
}
