//! One graph over several machines: laser and map on one, the engine on another, a monitor on a
//! third, joined by bridges.
//!
//! The machines are separate graphs on this computer, over loopback connections or in network
//! namespaces with virtual cables, which can be pulled.

use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

use messages::{HypothesesHeader, Hypothesis, topic};
use tests::answers;
use tests::machine::{ENGINE, LASER, MONITOR, Machine};
use tests::network::{self, Namespace};
use tests::world::World;
use transport::testing::{NodeProcess, wait_for, wait_for_health, wait_until};
use transport::{Flow, Graph, Subscriber, TransportError};

/// Number of scans in the recording.
const SCANS: usize = 37;

/// Options with which the player waits for the answer to each scan, so that nothing is dropped.
const LOSSLESS: [&str; 4] = ["--rate", "max", "--wait-for", "accumulator,peak_extractor"];

/// Addresses of the laser's machine for the engine's and the monitor's machine, in namespaces.
const FROM_ENGINE: [&str; 2] = ["--connect", "tcp/10.77.1.1:7447"];
const FROM_MONITOR: [&str; 2] = ["--connect", "tcp/10.77.2.1:7447"];
const LISTEN: [&str; 2] = ["--listen", "tcp/0.0.0.0:7447"];

fn machine<'a>(tag: &str, descriptor: &str, place: Option<&'a Namespace>) -> Machine<'a> {
    Machine::new(tag, env!("CARGO_BIN_EXE_bridge"), descriptor, place)
}

type Answer = (HypothesesHeader, Vec<Hypothesis>);

fn world() -> World {
    World::of("malaga_corridor")
}

fn collect(graph: &Graph, hypotheses: &Subscriber<topic::Hypotheses>) -> Vec<Answer> {
    let mut found = Vec::new();
    wait_until(graph, hypotheses, |header, items| {
        found.push((*header, items.to_vec()));
        found.len() == SCANS
    });
    found
}

/// Plays the recording on the laser's machine, and collects the answers on that of `watcher`.
fn answers_at(watcher: &Machine<'_>, laser: &Machine<'_>, engine: &Machine<'_>) -> Vec<Answer> {
    let hypotheses = watcher.graph.subscriber().unwrap();
    let health = watcher.graph.subscriber().unwrap();
    let mut nodes = engine.engine();
    nodes.push(laser.map_server(&world().map()));
    // The player does not wait for remote watchers.
    wait_for_health(&watcher.graph, &health, |report| {
        report.node.as_str() == "peak_extractor"
    });
    let source = laser.replayer(&world().recording(), &LOSSLESS);
    let found = collect(&watcher.graph, &hypotheses);
    assert_eq!(source.exit_code(), Some(0), "the player lost something");
    nodes.into_iter().for_each(NodeProcess::stop);
    found
}

/// Compares with the answers of a single machine: bit-identical except for the times.
fn assert_same(found: &[Answer]) {
    static ONE: LazyLock<Vec<Answer>> = LazyLock::new(|| {
        let world = world();
        answers::of_graph("one", &world.recording(), &world.map(), SCANS, &[], &[]).hypotheses
    });
    assert_eq!((found.len(), ONE.len()), (SCANS, SCANS));
    for ((header, poses), (expected_header, expected_poses)) in found.iter().zip(&*ONE) {
        let counter = header.stamp.counter;
        assert_eq!(counter, expected_header.stamp.counter);
        assert_eq!(header.stamp.measured_ns, expected_header.stamp.measured_ns);
        assert_eq!(header.map_id, expected_header.map_id);
        assert_eq!(header.verdict, expected_header.verdict, "scan {counter}");
        assert_eq!(poses, expected_poses, "scan {counter}");
    }
}

#[test]
fn poses_are_those_of_one_machine() {
    let laser = machine("laser", LASER, None);
    let engine = machine("engine", ENGINE, None);
    let endpoint = laser.loopback();
    let bridges = [
        engine.bridge(&["--connect", &endpoint]),
        laser.bridge(&["--listen", &endpoint]),
    ];
    let found = answers_at(&laser, &laser, &engine);
    bridges.into_iter().for_each(NodeProcess::stop);
    assert_same(&found);
}

/// Creates namespaces with a cable from the first one to each of the others.
fn star<const N: usize>() -> [Namespace; N] {
    let all: [Namespace; N] = std::array::from_fn(|_| Namespace::new());
    let (hub, others) = all.split_first().unwrap();
    for (i, other) in others.iter().enumerate() {
        let i = i + 1;
        let ends = [format!("10.77.{i}.1/24"), format!("10.77.{i}.2/24")];
        hub.connect(other, &format!("cable{i}"), [&ends[0], &ends[1]]);
    }
    all
}

#[test]
fn three_machines_answer_as_one() {
    if !network::is_allowed("three_machines_answer_as_one") {
        return;
    }
    let places: [Namespace; 3] = star();
    let laser = machine("laser3", LASER, Some(&places[0]));
    let engine = machine("engine3", ENGINE, Some(&places[1]));
    let monitor = machine("monitor3", MONITOR, Some(&places[2]));
    let bridges = [
        monitor.bridge(&FROM_MONITOR),
        engine.bridge(&FROM_ENGINE),
        laser.bridge(&LISTEN),
    ];
    let found = answers_at(&monitor, &laser, &engine);
    bridges.into_iter().for_each(NodeProcess::stop);
    assert_same(&found);
}

/// Messages received on a machine without the laser.
struct Received<'a> {
    machine: &'a Machine<'a>,
    maps: Subscriber<topic::Map>,
    hypotheses: Subscriber<topic::Hypotheses>,
    /// Ids of the maps, in order of arrival.
    map_ids: Vec<u64>,
    counters: Vec<u64>,
}

impl<'a> Received<'a> {
    fn new(machine: &'a Machine<'a>) -> Self {
        Received {
            machine,
            maps: machine.graph.subscriber().unwrap(),
            hypotheses: machine.graph.subscriber().unwrap(),
            map_ids: Vec::new(),
            counters: Vec::new(),
        }
    }

    /// Waits for the map with this id and for an answer on it to a scan after `counter`; they
    /// arrive on separate connections, in either order.
    fn until(&mut self, map_id: u64, counter: u64) {
        let graph = &self.machine.graph;
        let tick = Duration::from_millis(100);
        let mut is_answered = false;
        let outcome = graph.run(&[&self.maps, &self.hypotheses], tick, |_| {
            while let Some(map) = self.maps.receive()? {
                self.map_ids.push(map.header().map_id);
            }
            while let Some(answer) = self.hypotheses.receive()? {
                let header = answer.header();
                self.counters.push(header.stamp.counter);
                is_answered |= header.map_id == map_id && header.stamp.counter > counter;
            }
            let is_all = is_answered && self.map_ids.contains(&map_id);
            let flow = if is_all { Flow::Stop } else { Flow::Continue };
            Ok::<_, TransportError>(flow)
        });
        outcome.unwrap();
    }
}

/// Returns the id of the map that is served next on the laser's machine and differs from `not`.
fn served(machine: &Machine<'_>, maps: &Subscriber<topic::Map>, not: u64) -> u64 {
    wait_for(&machine.graph, maps, |header, _| {
        (header.map_id != not).then_some(header.map_id)
    })
}

/// Returns the counter of the scan that follows this many others.
fn scan_after(machine: &Machine<'_>, scans: u64) -> u64 {
    let played = machine.graph.subscriber::<topic::Scan>().unwrap();
    let mut seen = 0;
    wait_for(&machine.graph, &played, |header, _| {
        seen += 1;
        (seen > scans).then_some(header.stamp.counter)
    })
}

/// Changes a map by one cell in its corner.
fn change(map: &Path) {
    let mut grid = map::load(map).unwrap();
    grid.cells[0] = if grid.cells[0] == 100 { 0 } else { 100 };
    map::save(&grid, map).unwrap();
}

/// Number of scans in ten seconds, at five per second.
const OUTAGE: u64 = 50;

#[test]
fn a_cable_that_was_pulled_is_plugged_in_and_all_goes_on() {
    if !network::is_allowed("a_cable_that_was_pulled_is_plugged_in_and_all_goes_on") {
        return;
    }
    let places: [Namespace; 3] = star();
    let laser = machine("laser4", LASER, Some(&places[0]));
    let engine = machine("engine4", ENGINE, Some(&places[1]));
    let monitor = machine("monitor4", MONITOR, Some(&places[2]));
    let maps = laser.graph.subscriber::<topic::Map>().unwrap();
    let map = laser.copy_of_map(&world().map());
    let mut received = Received::new(&monitor);
    let mut nodes = engine.engine();
    nodes.extend([
        monitor.bridge(&FROM_MONITOR),
        engine.bridge(&FROM_ENGINE),
        laser.bridge(&LISTEN),
        laser.map_server(&map),
        laser.replayer(&world().recording(), &["--loop"]),
    ]);
    let first = served(&laser, &maps, 0);
    received.until(first, 0);
    for cable in ["cable1", "cable2"] {
        places[0].pull(cable);
    }
    // Meanwhile the map changes.
    change(&map);
    let second = served(&laser, &maps, first);
    let back = scan_after(&laser, OUTAGE);
    for cable in ["cable1", "cable2"] {
        places[0].plug(cable);
    }
    received.until(second, back);
    // Each map and each answer arrives once, even if it was sent again.
    assert_eq!(received.map_ids, [first, second]);
    let counters = &received.counters;
    assert!(counters.is_sorted_by(|a, b| a < b), "{counters:?}");
    // New subscribers still get the map and the boundary sent long ago.
    let late = engine.graph.subscriber::<topic::Boundary>().unwrap();
    wait_until(&engine.graph, &late, |header, _| header.map_id == second);
    let late = monitor.graph.subscriber::<topic::Map>().unwrap();
    wait_until(&monitor.graph, &late, |header, _| header.map_id == second);
    // No process was lost: each can still be stopped.
    nodes.into_iter().for_each(NodeProcess::stop);
}
