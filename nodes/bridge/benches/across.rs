//! Prints the delay added by the network: from a new map to its arrival, and from scan to pose
//! without the engine's computing time, on one machine and over a cable between two network
//! namespaces; and the time in which a late joiner receives the map and its boundary.
//!
//!     cargo bench -p bridge --bench across
//!
//! It needs the right to create network namespaces, like the tests.
#![allow(clippy::unwrap_used, reason = "it fails where a test would")]

use std::time::Instant;

use messages::{MapHeader, ScanHeader, Stamp, topic};
use tests::machine::{ENGINE, LASER, Machine};
use tests::network::Namespace;
use tests::world::{World, as_the_graph_has_it};
use transport::stamp_now;
use transport::testing::{NodeProcess, wait_for, wait_for_health, wait_until, wait_until_ready};

/// Number of times that the recording is played.
const ROUNDS: usize = 4;
/// Number of maps sent.
const MAPS: u64 = 40;
/// Number of late joiners measured.
const JOINS: usize = 10;
/// Number of cells along x and y: 3 MB.
const SIDES: (u32, u32) = (2000, 1500);
/// Options of the machine that listens, and of the others, which connect to it.
const LISTEN: [&str; 2] = ["--listen", "tcp/0.0.0.0:7447"];
const CONNECT: [&str; 2] = ["--connect", "tcp/10.77.1.1:7447"];

fn machine<'a>(tag: &str, descriptor: &str, place: &'a Namespace) -> Machine<'a> {
    Machine::new(tag, env!("CARGO_BIN_EXE_bridge"), descriptor, Some(place))
}

fn main() {
    let world = World::of("malaga_corridor");
    let places = [Namespace::new(), Namespace::new()];
    places[0].connect(&places[1], "cable1", ["10.77.1.1/24", "10.77.1.2/24"]);
    println!("{:<38} {:>8} {:>8}", "milliseconds", "median", "p90");
    map_to_one(&places, &world);
    map_to_other(&places, &world);
    scan_on_one(&places, &world);
    scan_over_both(&places, &world);
    late_joiners(&places, &world);
}

fn map_to_one(places: &[Namespace; 2], world: &World) {
    let machine = machine("map1", LASER, &places[0]);
    maps(&machine, &machine, world).print("3 MB of map, one machine");
}

fn map_to_other(places: &[Namespace; 2], world: &World) {
    let laser = machine("map2a", LASER, &places[0]);
    let engine = machine("map2b", ENGINE, &places[1]);
    let bridges = [laser.bridge(&LISTEN), engine.bridge(&CONNECT)];
    maps(&laser, &engine, world).print("3 MB of map, two machines");
    bridges.into_iter().for_each(NodeProcess::stop);
}

fn scan_on_one(places: &[Namespace; 2], world: &World) {
    let machine = machine("scan1", LASER, &places[0]);
    let mut nodes = machine.engine();
    nodes.push(machine.map_server(&world.map()));
    scans(&machine, world).print("scan to pose, one machine");
    nodes.into_iter().for_each(NodeProcess::stop);
}

fn scan_over_both(places: &[Namespace; 2], world: &World) {
    let laser = machine("scan2a", LASER, &places[0]);
    let engine = machine("scan2b", ENGINE, &places[1]);
    let mut nodes = engine.engine();
    nodes.extend([
        laser.bridge(&LISTEN),
        engine.bridge(&CONNECT),
        laser.map_server(&world.map()),
    ]);
    scans(&laser, world).print("scan to pose and back, two machines");
    nodes.into_iter().for_each(NodeProcess::stop);
}

fn late_joiners(places: &[Namespace; 2], world: &World) {
    let laser = machine("late", LASER, &places[0]);
    let here = [laser.bridge(&LISTEN), laser.map_server(&world.map())];
    let served = laser.graph.subscriber::<topic::Map>().unwrap();
    wait_until(&laser.graph, &served, |_, _| true);
    let (mut machines, mut nodes) = (Vec::new(), Vec::new());
    for i in 0..JOINS {
        let engine = machine(&format!("late{i}"), ENGINE, &places[1]);
        let health = engine.graph.subscriber().unwrap();
        let mut there = engine.engine();
        // All nodes but the bridge have started.
        wait_for_health(&engine.graph, &health, |report| {
            report.node.as_str() == "boundary_extractor"
        });
        let start = Instant::now();
        there.push(engine.bridge(&CONNECT));
        machines.push(map_and_boundary(&engine, start));
        nodes.push(map_and_boundary(&engine, Instant::now()));
        there.into_iter().for_each(NodeProcess::stop);
    }
    here.into_iter().for_each(NodeProcess::stop);
    Times(machines).print("late machine: map and boundary");
    Times(nodes).print("late node: map and boundary");
}

/// Returns the milliseconds until a new member of the machine's graph has received both.
fn map_and_boundary(machine: &Machine<'_>, start: Instant) -> f64 {
    let maps = machine.graph.subscriber::<topic::Map>().unwrap();
    let boundaries = machine.graph.subscriber::<topic::Boundary>().unwrap();
    wait_until(&machine.graph, &maps, |_, _| true);
    wait_until(&machine.graph, &boundaries, |_, _| true);
    start.elapsed().as_secs_f64() * 1e3
}

/// Sends maps on one machine, each after the previous one has arrived on the other.
fn maps(from: &Machine<'_>, to: &Machine<'_>, world: &World) -> Times {
    let publisher = from.graph.publisher::<topic::Map>().unwrap();
    let received = to.graph.subscriber::<topic::Map>().unwrap();
    let (width, height) = SIDES;
    let mut cells = repeated(world);
    let mut times = Vec::new();
    for counter in 1..=MAPS {
        // Each map differs by a single cell.
        cells[counter as usize] ^= 1;
        let mut map = MapHeader {
            stamp: stamp(counter),
            width,
            height,
            resolution_m: 0.05,
            ..MapHeader::default()
        };
        map.map_id = map.id_of(&cells);
        let start = Instant::now();
        publisher.send(map, &cells).unwrap();
        wait_until(&to.graph, &received, |header, _| {
            header.map_id == map.map_id
        });
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    // The first map includes the time in which the bridges find each other.
    times.remove(0);
    Times(times)
}

/// Returns the map of the recording, repeated until it is large enough.
fn repeated(world: &World) -> Vec<u8> {
    let map = map::load(world.map()).unwrap();
    let (width, height) = SIDES;
    let cell = |x, y| map.cells[((y % map.height) * map.width + x % map.width) as usize];
    let rows = 0..height;
    rows.flat_map(|y| (0..width).map(move |x| cell(x, y)))
        .collect()
}

/// Sends scans on one machine, each after the answer to the previous one; returns the times without
/// computing.
fn scans(laser: &Machine<'_>, world: &World) -> Times {
    // The health of these nodes is received here, wherever they run.
    for node in ["accumulator", "peak_extractor"] {
        wait_until_ready(&laser.graph, node);
    }
    let publisher = laser.graph.publisher::<topic::Scan>().unwrap();
    let answers = laser.graph.subscriber::<topic::Hypotheses>().unwrap();
    let recorded = world.scans();
    let mut times = Vec::new();
    for (counter, scan) in (0..ROUNDS).flat_map(|_| &recorded).enumerate() {
        let counter = counter as u64;
        let start = Instant::now();
        let header = ScanHeader {
            // The recording is played several times, but stamps must increase.
            stamp: stamp(counter),
            ..as_the_graph_has_it(scan, counter)
        };
        publisher.send(header, &scan.ranges).unwrap();
        let computing_ns = wait_for(&laser.graph, &answers, |header, _| {
            let computing_ns = header.search_ns + header.extract_ns;
            (header.stamp.counter == counter).then_some(computing_ns)
        });
        times.push(start.elapsed().as_secs_f64() * 1e3 - computing_ns as f64 / 1e6);
    }
    Times(times)
}

fn stamp(counter: u64) -> Stamp {
    stamp_now(counter as i64, counter)
}

/// Times in milliseconds.
struct Times(Vec<f64>);

impl Times {
    fn print(mut self, what: &str) {
        self.0.sort_by(f64::total_cmp);
        let at = |share: f64| self.0[(share * (self.0.len() - 1) as f64).round() as usize];
        println!("{what:<38} {:>8.2} {:>8.2}", at(0.5), at(0.9));
    }
}
