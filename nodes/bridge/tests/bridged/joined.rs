//! Two graphs joined by two bridges over a loopback connection, and unknown senders of invalid
//! data.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bytemuck::Zeroable;
use messages::{FrameName, Name, Pose2, PoseHeader, ScanHeader, Stamp, TrackState, topic};
use network_payload::{Preamble, Wire};
use tests::drawn_map::DrawnMap;
use tests::machine::Machine;
use tests::needs::Need;
use tests::python;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until};
use transport::{Flow, Graph, TransportError, monotonic_ns};
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::sample::SampleKind;
use zenoh_session::testing::client;

/// Machine with the laser and the map.
const LASER: &str = "nodes:
  - {id: laser, path: x, outputs: [scan, map]}
  - {id: bridge, path: y, inputs: {scan: laser/scan, map: laser/map}, outputs: [hypotheses]}
";
/// Machine with a tracker.
const TRACKER: &str = "nodes:
  - {id: tracker, path: x, outputs: [pose]}
  - {id: bridge, path: y, inputs: {pose: tracker/pose}}
";
/// Machine with the engine.
const ENGINE: &str = "nodes:
  - {id: engine, path: x, inputs: {scan: bridge/scan}, outputs: [hypotheses]}
  - {id: bridge, path: y, inputs: {hypotheses: engine/hypotheses}, outputs: [scan, map]}
";

fn machine(tag: &str, descriptor: &str) -> Machine<'static> {
    Machine::new(tag, env!("CARGO_BIN_EXE_bridge"), descriptor, None)
}

fn scan(counter: u64) -> ScanHeader {
    ScanHeader {
        stamp: Stamp {
            measured_ns: 1_000 * counter as i64,
            entered_ns: monotonic_ns(),
            counter,
        },
        angle_min: -1.5,
        angle_increment: 0.01,
        time_increment_s: 0.0,
        scan_time_s: 0.1,
        range_min_m: 0.1,
        range_max_m: 30.0,
        base_from_laser: Pose2 {
            x: 0.1,
            y: 0.0,
            yaw: 0.0,
        },
        mount_known: 1,
        upside_down: 0,
        laser: Name::new("front"),
        frame: FrameName::new("laser"),
    }
}

/// Returns ranges that differ for each scan, with one beam without a return.
fn ranges(counter: u64) -> Vec<f32> {
    let mut ranges: Vec<_> = (0..181)
        .map(|i| (counter * 181 + i) as f32 / 100.0)
        .collect();
    ranges[7] = f32::INFINITY;
    ranges
}

fn map(width: u32, height: u32) -> DrawnMap {
    let cells = (0..width * height).map(|i| (i * i % 101) as u8);
    let mut map = DrawnMap::new(width, 0.05, cells.collect());
    map.header.map_from_grid = pose2(-3.0, 2.0);
    map.header.map_id = map.header.id_of(&map.cells);
    map
}

/// Sends scans until `stop` is set, on a thread of its own, because a member of a graph stays on
/// its thread.
fn send_scans(isolated: &Isolated, stop: &Arc<AtomicBool>) -> std::thread::JoinHandle<()> {
    let name = isolated.name().clone();
    let stop = Arc::clone(stop);
    std::thread::spawn(move || {
        let graph = Graph::join_named("laser", &name).unwrap();
        let scans = graph.publisher::<topic::Scan>().unwrap();
        let mut counter = 0;
        let period = Duration::from_millis(20);
        let outcome = graph.run(&[], period, |_| {
            let ranges = ranges(counter);
            scans.send(scan(counter), &ranges)?;
            counter += 1;
            let stop = stop.load(Ordering::Relaxed);
            Ok::<_, TransportError>(if stop { Flow::Stop } else { Flow::Continue })
        });
        outcome.unwrap();
    })
}

#[test]
fn scans_cross_as_they_are_and_nobody_else_receives_them() {
    let laser = machine("live-a", LASER);
    let engine = machine("live-b", ENGINE);
    let other = machine("live-c", ENGINE).of_robot("r2");
    let alone = Isolated::new("live-d");
    let alone = (alone.join("test"), alone);
    let endpoint = laser.loopback();
    let scans = engine.graph.subscriber::<topic::Scan>().unwrap();
    let foreign = other.graph.subscriber::<topic::Scan>().unwrap();
    let unjoined = alone.0.subscriber::<topic::Scan>().unwrap();
    let bridges = [
        laser.joined_bridge(&["--listen", &endpoint]),
        engine.joined_bridge(&["--connect", &endpoint]),
        // Another robot on the same network.
        other.joined_bridge(&["--connect", &endpoint]),
    ];
    let stop = Arc::new(AtomicBool::new(false));
    let source = send_scans(laser.isolated(), &stop);
    let mut counters = Vec::new();
    wait_until(&engine.graph, &scans, |header, items| {
        let counter = header.stamp.counter;
        let entered_ns = header.stamp.entered_ns;
        assert!(entered_ns <= monotonic_ns(), "a scan of the future");
        let mut expected = scan(counter);
        expected.stamp.entered_ns = entered_ns;
        assert_eq!(*header, expected);
        assert_eq!(items, ranges(counter));
        counters.push(counter);
        counters.len() == 100
    });
    stop.store(true, Ordering::Relaxed);
    source.join().unwrap();
    // Each scan once and in order; on a loaded machine the queues may overflow, and live messages
    // are then dropped.
    assert!(counters.is_sorted_by(|a, b| a < b), "{counters:?}");
    assert!(foreign.receive().unwrap().is_none(), "another robot's");
    assert!(unjoined.receive().unwrap().is_none(), "no bridge, no scan");
    bridges.into_iter().for_each(NodeProcess::stop);
}

#[test]
fn a_late_joiner_gets_the_map_once() {
    let laser = machine("late-a", LASER);
    let engine = machine("late-b", ENGINE);
    let endpoint = laser.loopback();
    let maps = laser.graph.publisher::<topic::Map>().unwrap();
    let sent = map(300, 200);
    sent.send(&maps);
    let first = laser.joined_bridge(&["--listen", &endpoint]);
    let received = engine.graph.subscriber::<topic::Map>().unwrap();
    let second = engine.joined_bridge(&["--connect", &endpoint]);
    let expect = |sent: &DrawnMap| {
        wait_until(&engine.graph, &received, |header, cells| {
            assert_eq!(header.map_id, sent.header.map_id, "a map came twice");
            let sides = (sent.header.width, sent.header.height);
            assert_eq!((header.width, header.height), sides);
            assert_eq!(header.map_from_grid, sent.header.map_from_grid);
            assert_eq!(cells, sent.cells);
            true
        });
    };
    expect(&sent);
    // A subscriber that joins later receives it from the bridge.
    let later = engine.graph.subscriber::<topic::Map>().unwrap();
    wait_until(&engine.graph, &later, |header, _| {
        header.map_id == sent.header.map_id
    });
    // A restarted bridge repeats nothing, and new maps arrive.
    first.kill();
    laser.graph.cleanup_dead_nodes();
    let first = laser.joined_bridge(&["--listen", &endpoint]);
    let next = map(20, 10);
    next.send(&maps);
    expect(&next);
    first.stop();
    second.stop();
}

#[test]
fn what_strangers_send_is_refused_and_counted() {
    let engine = machine("hostile", ENGINE);
    let scans = engine.graph.subscriber::<topic::Scan>().unwrap();
    let health = engine.graph.subscriber::<topic::Health>().unwrap();
    let endpoint = engine.loopback();
    let bridge = engine.joined_bridge(&["--listen", &endpoint]);
    let stranger = client(&endpoint);
    let good = |sequence| {
        let preamble = Preamble {
            sender: 1,
            sequence,
            clock_ns: monotonic_ns(),
        };
        network_payload::encode::<topic::Scan>(&preamble, &scan(sequence), &[1.0, 2.0]).unwrap()
    };
    let key = network_payload::key::<topic::Scan>("r1");
    let put_with = |attachment: Vec<u8>, encoding: &str, payload: Vec<u8>| {
        let put = stranger
            .put(&key, payload)
            .encoding(Encoding::from(encoding))
            .attachment(attachment);
        put.congestion_control(zenoh::qos::CongestionControl::Block)
            .wait()
            .unwrap();
    };
    let put = |encoding: &str, payload: Vec<u8>| put_with(Vec::new(), encoding, payload);
    let sound = network_payload::encoding::<topic::Scan>();
    let mut nan = good(1);
    let angle = (-1.5f64).to_le_bytes();
    let at = nan.windows(8).position(|bytes| bytes == angle).unwrap();
    nan[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let mut cut = good(2);
    cut.truncate(cut.len() - 1);
    let refused = [
        ("backcast.Scan/v9", good(3)),
        (sound.as_str(), nan),
        (sound.as_str(), cut),
        (sound.as_str(), Vec::new()),
        (sound.as_str(), vec![0xff; topic::Scan::MAX_BYTES + 1]),
        (sound.as_str(), vec![0xff; 1000]),
    ];
    let mut count = 0;
    for (encoding, payload) in refused {
        put(encoding, payload);
        count += 1;
        // One after the other, so that the queue does not overflow.
        let (report, error) = wait_for_health(&engine.graph, &health, |report| {
            report.node.as_str() == "bridge" && report.refused >= count
        });
        assert_eq!(report.refused, count, "{error}");
        assert!(!error.is_empty());
    }
    // What comes with a payload is kept with it, and counts.
    put_with(vec![0; 2 * topic::Scan::MAX_BYTES], &sound, good(4));
    wait_for_health(&engine.graph, &health, |report| {
        report.node.as_str() == "bridge" && report.refused == count + 1
    });
    // The bridge continues, and accepts each valid message once.
    for sequence in [5, 5, 6] {
        put(&sound, good(sequence));
    }
    let mut counters = Vec::new();
    wait_until(&engine.graph, &scans, |header, _| {
        counters.push(header.stamp.counter);
        header.stamp.counter == 6
    });
    assert_eq!(counters, [5, 6]);
    bridge.stop();
}

#[test]
fn who_watches_sees_bridges_and_nodes_come_and_go() {
    let engine = machine("alive", ENGINE);
    let endpoint = engine.loopback();
    let bridge = engine.joined_bridge(&["--listen", &endpoint]);
    let watcher = client(&endpoint);
    let (sender, changes) = std::sync::mpsc::channel();
    let _tokens = watcher
        .liveliness()
        .declare_subscriber("backcast/r1/alive/**")
        .history(true)
        .callback(move |sample| {
            let key = sample.key_expr().as_str();
            let node = key.split('/').nth(4).unwrap_or("").to_owned();
            let _ = sender.send((node, sample.kind()));
        })
        .wait()
        .unwrap();
    let until = |node: &str, kind: SampleKind| {
        let wanted = (node.to_owned(), kind);
        while changes.recv().unwrap() != wanted {}
    };
    until("", SampleKind::Put);
    // A node is alive from its first report to its last.
    let joined = engine.isolated().join("engine");
    let health = joined.health().unwrap();
    until("engine", SampleKind::Put);
    health.stop().unwrap();
    until("engine", SampleKind::Delete);
    bridge.kill();
    until("", SampleKind::Delete);
}

/// Runs the example of docs/bridge.md with Zenoh's Python library.
#[test]
fn ten_lines_of_python_print_where_the_robot_is() {
    let found = python::with("robot", &tests::robot::LIBRARIES, "zenoh");
    let python = match found {
        Ok(python) => python,
        Err(why) => return Need::Python.is_missing("a pose in Python", &why),
    };
    let robot = machine("json", TRACKER);
    let endpoint = robot.loopback();
    let _bridge = robot.joined_bridge(&["--listen", &endpoint]);
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/zenoh/pose.py");
    let mut command = Command::new(python);
    command.arg(example).args([&endpoint, "r1"]);
    let mut process = command.stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
    let (said, line) = std::sync::mpsc::channel();
    std::thread::spawn(move || said.send(lines.next()));
    let poses = robot.graph.publisher::<topic::Tracked>().unwrap();
    let words = "at one place".as_bytes();
    let mut printed = None;
    let outcome = robot.graph.run(&[], Duration::from_millis(20), |_| {
        let header = PoseHeader {
            state: TrackState::Unique as u32,
            pose_known: 1,
            mount_known: 1,
            map_from_base: pose2(1.5, -2.0),
            map_from_laser: pose2(2.25, -2.0),
            probability: 0.99,
            ..PoseHeader::zeroed()
        };
        poses.send(header, words)?;
        printed = line.try_recv().ok();
        let is_over = printed.is_some();
        Ok::<_, TransportError>(if is_over { Flow::Stop } else { Flow::Continue })
    });
    outcome.unwrap();
    process.kill().unwrap();
    process.wait().unwrap();
    let expected = "Unique {'x': 1.5, 'y': -2.0, 'yaw': 0.5} at one place";
    assert_eq!(printed.flatten().unwrap().unwrap(), expected);
}

fn pose2(x: f64, y: f64) -> Pose2 {
    Pose2 { x, y, yaw: 0.5 }
}
