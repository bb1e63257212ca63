//! Tests of the node as a process: maps go in, boundaries come out.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use engine::boundary;
use engine::grid::{CellRules, Grid};
use messages::{BoundaryCell, MapHeader, NodeState, Stamp, topic};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_for_next, wait_for_state};
use transport::{Graph, Publisher};

/// A room with a pillar; `#` occupied, `.` free.
const ROOM: [&str; 5] = ["########", "#......#", "#..#...#", "#......#", "########"];

fn start(graph: &Graph) -> NodeProcess {
    NodeProcess::start(env!("CARGO_BIN_EXE_boundary_extractor"), graph, [""; 0])
}

fn occupancy(rows: &[&str]) -> Vec<u8> {
    let cells = rows.iter().rev().flat_map(|row| row.bytes());
    cells.map(|cell| 100 * u8::from(cell == b'#')).collect()
}

fn publish(maps: &Publisher<topic::Map>, counter: u64, rows: &[&str]) -> u64 {
    let cells = occupancy(rows);
    let mut header = MapHeader {
        stamp: Stamp {
            counter,
            ..Stamp::default()
        },
        width: rows[0].len() as u32,
        height: rows.len() as u32,
        resolution_m: 0.1,
        ..MapHeader::default()
    };
    header.map_id = header.id_of(&cells);
    maps.send(header, &cells).unwrap();
    header.map_id
}

fn expected(rows: &[&str]) -> Vec<BoundaryCell> {
    let cells = occupancy(rows);
    let grid = Grid::new(rows[0].len(), rows.len(), &cells, CellRules::default());
    boundary::extract(&grid.unwrap())
}

#[test]
fn each_map_is_answered_with_its_boundary() {
    let isolated = Isolated::new("answer");
    let graph = isolated.join("test");
    let boundaries = graph.subscriber::<topic::Boundary>().unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    let node = start(&graph);
    wait_for_state(&graph, &health, NodeState::Waiting);

    let maps = graph.publisher::<topic::Map>().unwrap();
    let smaller = &ROOM[..4];
    for (counter, rows) in [(5, &ROOM[..]), (6, smaller)] {
        let map_id = publish(&maps, counter, rows);
        let (header, cells) = wait_for_next(&graph, &boundaries);
        assert_eq!((header.map_id, header.stamp.counter), (map_id, counter));
        assert_eq!(header.boundary_cells, cells.len() as u64);
        assert_eq!(cells, expected(rows));
    }
    wait_for_state(&graph, &health, NodeState::Ready);
    node.stop();
    let (last, _) = wait_for_state(&graph, &health, NodeState::Stopped);
    assert_eq!((last.received, last.sent, last.refused), (2, 2, 0));
}

#[test]
fn a_refused_map_leaves_the_boundary_before_it_in_service() {
    let isolated = Isolated::new("refused");
    let graph = isolated.join("test");
    let health = graph.subscriber::<topic::Health>().unwrap();
    let maps = graph.publisher::<topic::Map>().unwrap();
    let room = publish(&maps, 5, &ROOM);
    let node = start(&graph);
    // The map was published before the node started; it is delivered to late joiners.
    wait_for_state(&graph, &health, NodeState::Ready);

    let empty = publish(&maps, 6, &["....", "...."]);
    let (report, error) = wait_for_state(&graph, &health, NodeState::Degraded);
    assert_eq!((report.refused, report.sent), (1, 1));
    let expected = format!("map {empty:016x} rejected: the map has no occupied cell");
    assert!(error.starts_with(&expected), "{error}");
    let late = graph.subscriber::<topic::Boundary>().unwrap();
    let map_id = wait_for(&graph, &late, |header, _| Some(header.map_id));
    assert_eq!(map_id, room);

    let other = publish(&maps, 7, &ROOM[1..]);
    let map_id = wait_for(&graph, &late, |header, _| {
        (header.map_id != room).then_some(header.map_id)
    });
    assert_eq!(map_id, other);
    wait_for_state(&graph, &health, NodeState::Ready);
    node.stop();
}
