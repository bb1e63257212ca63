//! Tests of the node as a process: messages sent to it are in its file, even if it is killed.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bytemuck::Zeroable;
use messages::{
    FrameName, HypothesesHeader, Hypothesis, MapHeader, NodeState, ScanHeader, Stamp, Verdict,
    topic,
};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::{Kind, Message, Recording};
use tempfile::TempDir;
use transport::testing::{Isolated, NodeProcess, wait_for_health};
use transport::{Graph, Publisher, Subscriber, monotonic_ns};

const SECOND: i64 = 1_000_000_000;
const START: i64 = 1_137_772_793 * SECOND;

/// Node in a graph of its own, fed by the test.
struct World {
    node: Option<NodeProcess>,
    health: Subscriber<topic::Health>,
    maps: Publisher<topic::Map>,
    scans: Publisher<topic::Scan>,
    hypotheses: Publisher<topic::Hypotheses>,
    folder: TempDir,
    pid: i32,
    sent: u64,
    graph: Graph,
    _isolated: Isolated,
}

impl World {
    fn start(tag: &str, arguments: &[&str]) -> Self {
        World::start_by(tag, env!("CARGO_BIN_EXE_recorder"), &[], arguments)
    }

    /// Starts the node through another program, with `first` as its first arguments.
    fn start_by(tag: &str, program: &str, first: &[&str], arguments: &[&str]) -> Self {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let health = graph.subscriber::<topic::Health>().unwrap();
        let maps = graph.publisher::<topic::Map>().unwrap();
        let (scans, hypotheses) = (graph.publisher().unwrap(), graph.publisher().unwrap());
        let folder = TempDir::new().unwrap();
        let output = folder.path().join("r.mcap");
        let output = ["--output", output.to_str().unwrap()];
        let arguments = first.iter().chain(&output).chain(arguments);
        let node = NodeProcess::start(program, &graph, arguments);
        let is_ready = |report: &messages::HealthHeader| {
            report.node.as_str() == "recorder" && report.state == NodeState::Ready as u32
        };
        let (report, _) = wait_for_health(&graph, &health, is_ready);
        World {
            node: Some(node),
            health,
            maps,
            scans,
            hypotheses,
            folder,
            pid: report.pid.cast_signed(),
            sent: 0,
            graph,
            _isolated: isolated,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn send_map(&self) {
        let mut loan = self.maps.loan(2).unwrap();
        let mut header = MapHeader {
            width: 2,
            height: 1,
            resolution_m: 0.05,
            ..MapHeader::default()
        };
        header.map_id = header.id_of(&[0, 100]);
        *loan.header_mut() = header;
        loan.items_mut().copy_from_slice(&[0, 100]);
        loan.send().unwrap();
    }

    /// Sends a scan and waits until it is taken, because the topic's queue is short.
    fn send_scan(&mut self) {
        let mut loan = self.scans.loan(3).unwrap();
        *loan.header_mut() = ScanHeader {
            stamp: self.stamp(),
            angle_min: -1.0,
            angle_increment: 1.0,
            range_max_m: 80.0,
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        loan.items_mut().copy_from_slice(&[1.0, 2.5, f32::INFINITY]);
        loan.send().unwrap();
        self.sent += 1;
        while !self.scans.is_settled().unwrap() {
            std::thread::yield_now();
        }
    }

    /// Sends a large scan and waits until it is taken.
    fn send_noise(&mut self, state: &mut u64) {
        let mut loan = self.scans.loan(LARGE).unwrap();
        *loan.header_mut() = ScanHeader {
            stamp: self.stamp(),
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        for range in loan.items_mut() {
            // Knuth's linear congruential generator; its upper bits are good.
            *state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            *range = (*state >> 40) as f32;
        }
        loan.send().unwrap();
        self.sent += 1;
        while !self.scans.is_settled().unwrap() {
            std::thread::yield_now();
        }
    }

    fn send_hypothesis(&mut self, verdict: Verdict) {
        let mut loan = self.hypotheses.loan(1).unwrap();
        *loan.header_mut() = HypothesesHeader {
            stamp: self.stamp(),
            verdict: verdict as u32,
            ..HypothesesHeader::zeroed()
        };
        loan.items_mut()[0] = Hypothesis::zeroed();
        loan.send().unwrap();
        self.sent += 1;
        while !self.hypotheses.is_settled().unwrap() {
            std::thread::yield_now();
        }
    }

    fn stamp(&self) -> Stamp {
        Stamp {
            measured_ns: START + self.sent as i64 * SECOND / 10,
            entered_ns: monotonic_ns(),
            counter: self.sent,
        }
    }

    /// Waits until the node reports this many messages as written.
    fn wait_for_written(&self, messages: u64) {
        let awaited = |report: &messages::HealthHeader| {
            report.node.as_str() == "recorder" && report.sent >= messages
        };
        wait_for_health(&self.graph, &self.health, awaited);
    }

    fn take_node(&mut self) -> NodeProcess {
        self.node.take().unwrap()
    }
}

fn counts(path: &Path) -> BTreeMap<String, u64> {
    let recording = Recording::open(path).unwrap();
    let channels = recording.channels();
    channels
        .map(|channel| (channel.topic.to_string(), channel.messages))
        .collect()
}

#[test]
fn what_is_sent_is_recorded() {
    let mut world = World::start("sent", &[]);
    world.send_map();
    for _ in 0..20 {
        world.send_scan();
    }
    let (status, log) = {
        let node = world.take_node();
        node.interrupt();
        node.finish()
    };
    assert!(status.success(), "{log}");
    let path = world.path("r.mcap");
    let recording = Recording::open(&path).unwrap();
    assert_eq!(recording.damage(), None);
    assert_eq!((counts(&path)["/scan"], counts(&path)["/map"]), (20, 1));
    assert!(counts(&path)["/rosout"] > 0, "the recorder's own lines");
    assert_eq!(recording.map().unwrap().unwrap().cells, [0, 100]);
    assert_eq!(
        recording.metadata()[1].entries["map_id"],
        "967ce54b1de3971a"
    );
    for (number, record) in (0..).zip(recording.records_of(&[Kind::Scan])) {
        let record = record.unwrap();
        let Message::Scan(scan) = record.message else {
            panic!("asked for scans");
        };
        assert_eq!(record.log_time_ns, START + number * SECOND / 10);
        assert_eq!(scan.header.stamp.as_ns(), record.log_time_ns);
        assert_eq!((scan.angle_min, scan.angle_max), (-1.0, 1.0));
        assert_eq!(scan.ranges, [1.0, 2.5, f32::INFINITY]);
    }
}

#[test]
fn a_killed_recorder_has_lost_nothing_that_it_said_is_written() {
    let mut world = World::start("killed", &[]);
    for _ in 0..20 {
        world.send_scan();
    }
    world.wait_for_written(20);
    world.send_scan();
    world.take_node().kill();
    let recording = Recording::open(world.path("r.mcap")).unwrap();
    assert!(recording.damage().is_some(), "it has no end");
    assert!(counts(&world.path("r.mcap"))["/scan"] >= 20);
}

#[test]
fn a_file_that_exists_is_kept() {
    let mut world = World::start("exists", &[]);
    world.send_scan();
    world.take_node().stop();
    let first = std::fs::read(world.path("r.mcap")).unwrap();
    let output = world.path("r.mcap");
    let arguments = ["--output", output.to_str().unwrap()];
    let again = NodeProcess::start(env!("CARGO_BIN_EXE_recorder"), &world.graph, arguments);
    wait_for_health(&world.graph, &world.health, |report| {
        report.pid.cast_signed() != world.pid && report.state == NodeState::Ready as u32
    });
    again.stop();
    assert_eq!(std::fs::read(world.path("r.mcap")).unwrap(), first);
    assert!(world.path("r_1.mcap").exists());
}

#[test]
fn a_black_box_is_saved_when_asked_and_when_the_pose_is_lost() {
    let mut world = World::start("box", &["--keep", "1s"]);
    world.send_map();
    for _ in 0..20 {
        world.send_scan();
    }
    assert!(!world.path("r.mcap").exists());
    kill(Pid::from_raw(world.pid), Signal::SIGUSR1).unwrap();
    wait_for_file(&world, "r.mcap");
    world.send_hypothesis(Verdict::Unique);
    for _ in 0..5 {
        world.send_hypothesis(Verdict::Ambiguous);
    }
    world.take_node().stop();
    let asked = counts(&world.path("r.mcap"));
    assert_eq!(asked["/map"], 1, "from before");
    // One second of scans at 10 Hz, both ends included.
    assert_eq!(asked["/scan"], 11);
    let lost = Recording::open(world.path("r_1.mcap")).unwrap();
    assert_eq!(lost.damage(), None);
    assert_eq!(lost.metadata()[0].entries["reason"], "the pose was lost");
    assert_eq!(counts(&world.path("r_1.mcap"))["/hypotheses"], 6);
}

#[test]
fn a_black_box_is_saved_when_the_graph_asks() {
    let mut world = World::start("save", &["--keep", "1s"]);
    let saves = world.graph.publisher::<topic::Save>().unwrap();
    world.send_map();
    world.send_scan();
    saves.loan(0).unwrap().send().unwrap();
    wait_for_file(&world, "r.mcap");
    let saved = Recording::open(world.path("r.mcap")).unwrap();
    assert_eq!(saved.metadata()[0].entries["reason"], "asked by the graph");
    drop(saves);
    world.take_node().stop();
}

/// Waits until a file is complete.
fn wait_for_file(world: &World, name: &str) {
    let is_whole = || Recording::open(world.path(name)).is_ok_and(|r| r.damage().is_none());
    while !is_whole() {
        std::thread::yield_now();
    }
}

/// Size limit of the file, like a disk that fills up; larger than the shared memory segments of the
/// node.
const ROOM: usize = 8 << 20;
/// Number of beams of a large scan, mostly incompressible noise.
const LARGE: usize = 100_000;

#[test]
fn a_full_disk_is_reported_and_nothing_is_lost_once_there_is_room() {
    // The limit is in blocks of 512 or 1024 bytes.
    let script = format!(
        "trap '' XFSZ; ulimit -S -f {}; exec \"$0\" \"$@\"",
        ROOM / 1024
    );
    let node = env!("CARGO_BIN_EXE_recorder");
    let mut world = World::start_by("full", "/bin/sh", &["-c", &script, node], &[]);
    world.send_scan();
    world.wait_for_written(1);
    let mut noise = 1u64;
    // More than the limit, and less than the queue in memory holds.
    for _ in 0..3 * ROOM / (4 * LARGE) {
        world.send_noise(&mut noise);
    }
    let is_degraded = |report: &messages::HealthHeader| {
        report.node.as_str() == "recorder" && report.state == NodeState::Degraded as u32
    };
    let (_, said) = wait_for_health(&world.graph, &world.health, is_degraded);
    assert!(said.contains("File too large"), "{said}");
    let before = Recording::open(world.path("r.mcap")).unwrap();
    assert!(before.messages() > 0 && before.size() <= ROOM as u64);

    let outcome = std::process::Command::new("prlimit")
        .args(["--pid", &world.pid.to_string(), "--fsize=unlimited"])
        .status();
    assert!(outcome.unwrap().success(), "prlimit is part of util-linux");
    let is_ready = |report: &messages::HealthHeader| {
        report.node.as_str() == "recorder" && report.state == NodeState::Ready as u32
    };
    wait_for_health(&world.graph, &world.health, is_ready);
    world.send_noise(&mut noise);
    world.take_node().stop();
    let whole = Recording::open(world.path("r.mcap")).unwrap();
    assert_eq!(whole.damage(), None);
    assert_eq!(counts(&world.path("r.mcap"))["/scan"], world.sent);
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error() {
    let isolated = Isolated::new("nowhere");
    let graph = isolated.join("test");
    let arguments = ["--output", "/proc/no/such/r.mcap"];
    let node = NodeProcess::start(env!("CARGO_BIN_EXE_recorder"), &graph, arguments);
    let (status, log) = node.finish();
    assert_eq!(status.code(), Some(1));
    assert!(
        log.contains("cannot create the recording /proc/no/such/r.mcap"),
        "{log}"
    );
}
