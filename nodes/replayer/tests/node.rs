//! Tests of the node as a process; the test takes the part of all other nodes.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use std::ffi::OsStr;
use std::process::ExitStatus;

use geometry::Pose;
use messages::{NodeState, Stamp, topic};
use recording::Message;
use recording::write::{Packing, RecordingWriter};
use ros::{LaserScan, PoseStamped, Time};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_until};
use transport::{Graph, Publisher, Subscriber};

const SECOND: i64 = 1_000_000_000;

struct World {
    node: Option<NodeProcess>,
    folder: tempfile::TempDir,
    /// Subscriber to the scans; `None` to test without one.
    scans: Option<Subscriber<topic::Scan>>,
    odometry: Subscriber<topic::OdometryTopic>,
    truths: Subscriber<topic::GroundTruthTopic>,
    health: Subscriber<topic::Health>,
    answers: Publisher<topic::Hypotheses>,
    graph: Graph,
    _isolated: Isolated,
}

impl World {
    fn new(test: &str) -> World {
        let isolated = Isolated::new(test);
        let graph = isolated.join("accumulator");
        World {
            node: None,
            folder: tempfile::tempdir().unwrap(),
            scans: Some(graph.subscriber().unwrap()),
            odometry: graph.subscriber().unwrap(),
            truths: graph.subscriber().unwrap(),
            health: graph.subscriber().unwrap(),
            answers: graph.publisher().unwrap(),
            graph,
            _isolated: isolated,
        }
    }

    fn start(&mut self, bytes: &[u8], options: &[&str]) {
        let path = self.folder.path().join("world.mcap");
        std::fs::write(&path, bytes).unwrap();
        let recording = [OsStr::new("--recording"), path.as_os_str()];
        self.node = Some(NodeProcess::start(
            env!("CARGO_BIN_EXE_replayer"),
            &self.graph,
            recording.into_iter().chain(options.iter().map(OsStr::new)),
        ));
    }

    fn next_scan(&self) -> (Stamp, Vec<f32>) {
        let scans = self.scans.as_ref().unwrap();
        wait_for(&self.graph, scans, |header, ranges| {
            Some((header.stamp, ranges.to_vec()))
        })
    }

    fn no_scan_has_come(&self) -> bool {
        self.scans.as_ref().unwrap().receive().unwrap().is_none()
    }

    fn answer(&self, stamp: Stamp) {
        let mut loan = self.answers.loan(0).unwrap();
        loan.header_mut().stamp = stamp;
        loan.send().unwrap();
    }

    fn wait_for_state(&self, state: NodeState) {
        wait_until(&self.graph, &self.health, |header, _| {
            header.node.as_str() == "replayer" && header.state == state as u32
        });
    }

    fn interrupt(&self) {
        self.node.as_ref().unwrap().interrupt();
    }

    fn finish(&mut self) -> (ExitStatus, String) {
        self.node.take().unwrap().finish()
    }
}

fn header(stamp_ns: i64, frame: &str) -> ros::Header {
    ros::Header::new(Time::from_ns(stamp_ns).unwrap(), frame)
}

fn scan(stamp_ns: i64) -> Message {
    Message::Scan(LaserScan {
        header: header(stamp_ns, "laser"),
        angle_increment: 0.1,
        ranges: vec![stamp_ns as f32, f32::NAN],
        ..LaserScan::default()
    })
}

fn truth(stamp_ns: i64) -> Message {
    Message::PoseStamped(PoseStamped {
        header: header(stamp_ns, "map"),
        pose: ros::Pose::from_planar(Pose::new(1.0, 2.0, 0.5)),
    })
}

fn odometry(stamp_ns: i64) -> Message {
    Message::Odometry(Box::new(ros::Odometry {
        header: header(stamp_ns, "odom"),
        child_frame_id: "base_link".into(),
        ..ros::Odometry::default()
    }))
}

fn record(messages: &[(&str, i64, Message)]) -> Vec<u8> {
    let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
    for (topic, log_time_ns, message) in messages {
        writer.write(topic, *log_time_ns, message).unwrap();
        writer.flush().unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// Returns a recording of three scans, one second apart, each followed by ground truth and
/// odometry.
fn three_scans() -> Vec<u8> {
    let messages: Vec<_> = (0..3)
        .map(|index| (index + 1) * SECOND)
        .flat_map(|at| {
            [
                ("/scan", at, scan(at)),
                ("/ground_truth", at + 1, truth(at)),
                ("/odom", at + 2, odometry(at)),
            ]
        })
        .collect();
    record(&messages)
}

#[test]
fn at_max_each_scan_follows_the_answer_and_what_belongs_to_it() {
    let mut world = World::new("max");
    world.start(&three_scans(), &["--rate", "max"]);
    for counter in 0..3 {
        let (stamp, ranges) = world.next_scan();
        let measured_ns = (counter + 1) * SECOND;
        assert_eq!(
            (stamp.counter, stamp.measured_ns),
            (counter as u64, measured_ns)
        );
        assert!(ranges[0] == measured_ns as f32 && ranges[1].is_nan());
        // Messages that belong to the scan were sent before it, and nothing after it.
        let truth = world.truths.receive().unwrap().unwrap();
        assert_eq!(truth.header().stamp.measured_ns, measured_ns);
        assert_eq!(truth.header().map_from_laser.x, 1.0);
        let odometry = world.odometry.receive().unwrap().unwrap();
        assert_eq!(odometry.header().stamp.measured_ns, measured_ns);
        assert_eq!(odometry.header().child_frame.as_str(), "base_link");
        assert!(world.no_scan_has_come());
        assert!(world.truths.receive().unwrap().is_none());
        world.answer(stamp);
    }
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(0), "{log}");
    assert!(
        log.contains("played scans=3 answers=3 unanswered=0 refused=0"),
        "{log}"
    );
}

#[test]
fn a_scan_without_an_answer_is_counted_and_the_run_finishes_with_three() {
    let mut world = World::new("lost");
    world.start(&three_scans(), &["--rate", "max", "--patience", "0.1"]);
    let (stamp, _) = world.next_scan();
    assert_eq!(stamp.counter, 0);
    let (stamp, _) = world.next_scan();
    world.answer(stamp);
    world.next_scan();
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(3), "{log}");
    assert!(
        log.contains("scan 0, measured at 1000000000 ns, got no answer"),
        "{log}"
    );
    // The answer to scan 1 may be more than 0.1 s late on a busy machine; it is then given up as
    // well.
    assert!(log.contains("played scans=3"), "{log}");
}

#[test]
fn at_a_factor_nobody_is_waited_for_where_nobody_listens() {
    let mut world = World::new("deaf");
    world.scans = None;
    world.start(&three_scans(), &["--rate", "1000", "--patience", "3600"]);
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(0), "{log}");
    assert!(
        log.contains("played scans=3 answers=0 unanswered=0"),
        "{log}"
    );
}

#[test]
fn the_recording_starts_over() {
    let mut world = World::new("loop");
    world.start(&three_scans(), &["--rate", "max", "--loop"]);
    for counter in 0..7 {
        let (stamp, _) = world.next_scan();
        assert_eq!(stamp.counter, counter);
        assert_eq!(stamp.measured_ns, (counter as i64 % 3 + 1) * SECOND);
        world.answer(stamp);
    }
    world.interrupt();
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(0), "{log}");
}

#[test]
fn a_stop_ends_the_waiting() {
    let mut world = World::new("stop");
    world.start(&three_scans(), &["--wait-for", "nobody"]);
    world.wait_for_state(NodeState::Waiting);
    world.interrupt();
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(0), "{log}");
}

#[test]
fn a_recording_without_scans_is_an_error_that_says_what_it_has() {
    let mut world = World::new("none");
    world.start(&record(&[("/ground_truth", 1, truth(1))]), &[]);
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(1));
    for expected in ["world.mcap", "LaserScan", "/ground_truth"] {
        assert!(log.contains(expected), "{log}");
    }
}

#[test]
fn a_part_is_played_of_the_channels_that_are_named() {
    let mut world = World::new("part");
    let mut messages = Vec::new();
    for at in [SECOND, 2 * SECOND, 3 * SECOND] {
        messages.push(("/scan", at, scan(at)));
        messages.push(("/front/scan", at + 5, scan(at + 5)));
        messages.push(("/odom", at, odometry(at)));
    }
    let bytes = record(&messages);
    let options = "--start 1 --end 1.5 --rate max --topics /front/scan --remap /front/scan:=/scan";
    let options: Vec<&str> = options.split(' ').collect();
    world.start(&bytes, &options);
    let (stamp, _) = world.next_scan();
    assert_eq!(stamp.measured_ns, 2 * SECOND + 5);
    world.answer(stamp);
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(0), "{log}");
    assert!(log.contains("played scans=1 answers=1"), "{log}");
    assert!(
        world.odometry.receive().unwrap().is_none(),
        "it is not named"
    );
    world.start(&bytes, &["--topics", "/scam"]);
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(1));
    let expected = "has no /scam; it has /scan, /front/scan";
    assert!(log.contains(expected), "{log}");
}

#[test]
fn a_recording_that_is_cut_while_it_is_open_is_played_as_far_as_it_goes() {
    let mut world = World::new("cut-open");
    let mut health = world.graph.health().unwrap();
    world.start(&three_scans(), &["--wait-for", "accumulator"]);
    // It waits once it has read the recording.
    world.wait_for_state(NodeState::Busy);
    world.wait_for_state(NodeState::Waiting);
    let path = world.folder.path().join("world.mcap");
    let file = std::fs::File::options().write(true).open(path);
    file.unwrap().set_len(0).unwrap();
    health.state(NodeState::Ready).unwrap();
    world.wait_for_state(NodeState::Ready);
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(3), "{status} {log}");
    assert!(
        log.contains("world.mcap: the file is cut short: it ends at byte 0"),
        "{log}"
    );
}

#[test]
fn a_message_that_is_none_is_counted_and_the_rest_played() {
    let mut world = World::new("bad");
    let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
    let schema = "sensor_msgs/msg/LaserScan";
    writer.write("/scan", 1, &scan(1)).unwrap();
    writer
        .write_bytes("/scan", schema, "", "cdr", 2, &[0, 1, 0, 0, 9])
        .unwrap();
    writer.write("/scan", 3, &scan(3)).unwrap();
    let bytes = writer.finish().unwrap().into_inner();
    world.start(&bytes, &["--rate", "max"]);
    for measured_ns in [1, 3] {
        let (stamp, _) = world.next_scan();
        assert_eq!(stamp.measured_ns, measured_ns);
        world.answer(stamp);
    }
    let (status, log) = world.finish();
    assert_eq!(status.code(), Some(3), "{log}");
    assert!(log.contains("/scan at log time 2 ns"), "{log}");
}
