//! Tests of the node as a process: messages sent to it are in its file, even if it is killed.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

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
use transport::{Graph, Publisher, Subscriber, stamp_now};

const SECOND: i64 = 1_000_000_000;
const START: i64 = 1_137_772_793 * SECOND;

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
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let health = graph.subscriber::<topic::Health>().unwrap();
        let maps = graph.publisher::<topic::Map>().unwrap();
        let (scans, hypotheses) = (graph.publisher().unwrap(), graph.publisher().unwrap());
        let folder = TempDir::new().unwrap();
        let output = folder.path().join("r.mcap");
        let output = ["--output", output.to_str().unwrap()];
        let arguments = output.iter().chain(arguments);
        let node = NodeProcess::start(env!("CARGO_BIN_EXE_recorder"), &graph, arguments);
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
        let mut header = MapHeader {
            width: 2,
            height: 1,
            resolution_m: 0.05,
            ..MapHeader::default()
        };
        header.map_id = header.id_of(&[0, 100]);
        self.maps.send(header, &[0, 100]).unwrap();
    }

    /// Sends a scan and waits until it is taken, because the topic's queue is short.
    fn send_scan(&mut self) {
        let header = ScanHeader {
            stamp: self.stamp(),
            angle_min: -1.0,
            angle_increment: 1.0,
            range_max_m: 80.0,
            frame: FrameName::new("laser"),
            ..ScanHeader::zeroed()
        };
        self.scans.send(header, &[1.0, 2.5, f32::INFINITY]).unwrap();
        self.sent += 1;
        while !self.scans.is_settled().unwrap() {
            std::thread::yield_now();
        }
    }

    fn send_hypothesis(&mut self, verdict: Verdict) {
        let header = HypothesesHeader {
            stamp: self.stamp(),
            verdict: verdict as u32,
            ..HypothesesHeader::zeroed()
        };
        let items = [Hypothesis::zeroed()];
        self.hypotheses.send(header, &items).unwrap();
        self.sent += 1;
        while !self.hypotheses.is_settled().unwrap() {
            std::thread::yield_now();
        }
    }

    fn stamp(&self) -> Stamp {
        stamp_now(START + self.sent as i64 * SECOND / 10, self.sent)
    }

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
    world.take_node().stop();
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

fn wait_for_file(world: &World, name: &str) {
    let is_whole = || Recording::open(world.path(name)).is_ok_and(|r| r.damage().is_none());
    while !is_whole() {
        std::thread::yield_now();
    }
}
