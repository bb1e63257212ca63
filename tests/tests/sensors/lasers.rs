//! A recording through an emulated device and its reader: every scan arrives at the device's
//! resolution, and faults never let a wrong one through.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::path::{Path, PathBuf};
use std::time::Duration;

use messages::topic;
use recording::write::{Packing, RecordingWriter};
use recording::{Message, Recording};
use tests::world::World;
use tests::{answers, executables};
use transport::testing::{Isolated, NodeProcess};
use transport::{Flow, Graph, Subscriber, TransportError};

/// Connection between device and reader.
enum Cable {
    Tcp(&'static str),
    /// CoLa B, to a device with another convention for angles.
    Device(&'static str),
    Serial,
}

/// A device and its reader in a graph.
struct Robot {
    emulator: NodeProcess,
    reader: NodeProcess,
    scans: Subscriber<topic::Scan>,
    health: Subscriber<topic::Health>,
    graph: Graph,
    _folder: Option<tempfile::TempDir>,
    _isolated: Isolated,
}

impl Robot {
    fn start(tag: &str, cable: &Cable, emulator: &[&str]) -> Self {
        let isolated = Isolated::new(tag);
        let graph = isolated.join("test");
        let scans = graph.subscriber().unwrap();
        let health = graph.subscriber().unwrap();
        let start = |name: &str, arguments: &[&str]| executables::start(name, &graph, arguments);
        let recording = World::of("malaga_corridor").recording();
        let recording = ["--recording", recording.to_str().unwrap()];
        let (folder, device, reader) = ends(cable);
        let device: Vec<&str> = device.iter().map(String::as_str).collect();
        let reader: Vec<&str> = reader.iter().map(String::as_str).collect();
        Robot {
            emulator: start("emulator", &[&recording[..], &device, emulator].concat()),
            reader: start("lms_reader", &reader),
            scans,
            health,
            graph,
            _folder: folder,
            _isolated: isolated,
        }
    }

    /// Collects scans until `is_enough` returns true for their number and that of the reader's
    /// rejected telegrams.
    fn collect(&self, is_enough: impl Fn(usize, u64) -> bool) -> Vec<Vec<f32>> {
        let mut taken = Vec::new();
        let mut refused = 0;
        let step = |_| {
            while let Some(scan) = self.scans.receive()? {
                let header = scan.header();
                // Single precision, like in recordings.
                let recordable = |radians: f64| f64::from(radians as f32);
                assert_eq!(header.angle_min, recordable((-90f64).to_radians()));
                assert_eq!(header.angle_increment, recordable(0.5f64.to_radians()));
                taken.push(scan.items().to_vec());
            }
            while let Some(report) = self.health.receive()? {
                if report.header().node.as_str() == "lms_reader" {
                    refused = report.header().refused;
                }
            }
            Ok::<_, TransportError>(match is_enough(taken.len(), refused) {
                true => Flow::Stop,
                false => Flow::Continue,
            })
        };
        let inputs: [&dyn transport::Input; 2] = [&self.scans, &self.health];
        self.graph
            .run(&inputs, Duration::from_millis(100), step)
            .unwrap();
        taken
    }
}

/// Returns the arguments of device and reader, and the folder of the link between them.
fn ends(cable: &Cable) -> (Option<tempfile::TempDir>, Vec<String>, Vec<String>) {
    let words = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
    match cable {
        Cable::Tcp(protocol) => {
            // Each test has a graph of its own, and each graph an address.
            (
                None,
                words(&["--listen", "tcp://graph:2112", "--protocol", protocol]),
                words(&["--tcp", "graph:2112", "--protocol", protocol]),
            )
        }
        Cable::Device(name) => {
            let (none, mut device, reader) = ends(&Cable::Tcp("cola-b"));
            device.extend(words(&["--device", name]));
            (none, device, reader)
        }
        Cable::Serial => {
            let folder = tempfile::tempdir().unwrap();
            let link: PathBuf = folder.path().join("laser");
            let link = link.to_str().unwrap();
            let (device, reader) = (
                words(&["--pty", link, "--baud", "9600"]),
                words(&["--serial", link, "--baud", "500000"]),
            );
            (Some(folder), device, reader)
        }
    }
}

/// Plays the recording once and compares every reading; returns the scans.
fn every_scan_arrives(tag: &str, cable: &Cable, unit_m: f32) -> Vec<Vec<f32>> {
    let recorded = World::of("malaga_corridor").scans();
    // This test may have four scans in its queue, which is four fifths of a second.
    let robot = Robot::start(tag, cable, &["--rate", "1"]);
    let arrived = robot.collect(|scans, _| scans == recorded.len());
    assert_eq!(arrived.len(), recorded.len());
    for (index, (arrived, recorded)) in arrived.iter().zip(&recorded).enumerate() {
        assert_eq!(arrived.len(), recorded.ranges.len());
        for (beam, (&arrived, &recorded)) in arrived.iter().zip(&recorded.ranges).enumerate() {
            // Half a unit, and what f32 rounds at 80 m.
            let is_near = (arrived - recorded).abs() <= unit_m / 2.0 + 1e-5;
            assert!(
                arrived == recorded || is_near,
                "scan {index}, beam {beam}: {arrived} is not {recorded}"
            );
        }
    }
    robot.reader.stop();
    assert_eq!(robot.emulator.exit_code(), Some(0));
    arrived
}

/// Plays the recording in a loop over a bad cable: every scan that arrives is one of `sound`.
fn nothing_wrong_gets_through(tag: &str, cable: &Cable, sound: &[Vec<f32>]) {
    let faults = "crc=0.01,drop=0.01,garbage=0.01,split,merge";
    let robot = Robot::start(tag, cable, &["--loop", "--rate", "20", "--fault", faults]);
    let arrived = robot.collect(|scans, refused| scans >= 300 && refused >= 2);
    for (index, scan) in arrived.iter().enumerate() {
        assert!(sound.contains(scan), "scan {index} was never recorded");
    }
    robot.reader.stop();
    robot.emulator.stop();
}

/// Converts a range to a device's units and back; one outside them is infinite.
type Quantise = fn(f32) -> f32;

/// Steps of two millimetres in 16 bits; the lowest values are codes.
fn as_cola(range_m: f32) -> f32 {
    let units = (f64::from(range_m) * 500.0).round();
    match (16.0..=65535.0).contains(&units) {
        true => (units * 2.0 * 1e-3) as f32,
        false => f32::INFINITY,
    }
}

/// Steps of a centimetre in 13 bits; the highest values are codes.
fn as_lms2xx(range_m: f32) -> f32 {
    let units = (f64::from(range_m) * 100.0).round();
    match (0.0..=8182.0).contains(&units) {
        true => (units * 0.01) as f32,
        false => f32::INFINITY,
    }
}

/// Makes a copy of the corridor's recording with the ranges that a device measures, and with the
/// angles and limits of its reader.
fn quantised(folder: &Path, quantise: Quantise) -> PathBuf {
    let original = Recording::open(World::of("malaga_corridor").recording()).unwrap();
    let path = folder.join("quantised.mcap");
    let mut writer = RecordingWriter::create(&path, Packing::Zstd).unwrap();
    for record in original.records() {
        let mut record = record.unwrap();
        if let Message::Scan(scan) = &mut record.message {
            scan.angle_min = (-90f64).to_radians() as f32;
            scan.angle_increment = 0.5f64.to_radians() as f32;
            (scan.range_min, scan.range_max) = (0.05, 80.0);
            for range in &mut scan.ranges {
                *range = quantise(*range);
            }
        }
        let (topic, time) = (&record.topic, record.log_time_ns);
        writer.write(topic, time, &record.message).unwrap();
    }
    writer.finish().unwrap();
    path
}

/// Checks that the results on the corridor through a device are bit for bit those on a replay of
/// the ranges that the device can measure.
fn the_graph_answers_as_to_a_replay(tag: &str, cable: &Cable, quantise: Quantise) {
    let world = World::of("malaga_corridor");
    let scans = world.scans().len();
    let folder = tempfile::tempdir().unwrap();
    let (map, recording) = (world.map(), world.recording());
    let replay = quantised(folder.path(), quantise);
    let expected = answers::of_graph(&format!("{tag}r"), &replay, &map, scans, &[]);

    let (_link, device, mut reader) = ends(cable);
    reader.extend(["--mount", "0.78,0,0"].map(str::to_owned));
    let mut player = vec!["--recording", recording.to_str().unwrap(), "--rate", "max"];
    player.extend(["--wait-for", "accumulator,peak_extractor"]);
    player.extend(device.iter().map(String::as_str));
    let reader: Vec<&str> = reader.iter().map(String::as_str).collect();
    let (player, reader) = (("emulator", &player[..]), ("lms_reader", &reader[..]));
    let found = answers::of_graph_fed_by(tag, &map, scans, &[], &player, Some(&reader));

    assert_eq!((found.votes.len(), found.hypotheses.len()), (scans, scans));
    for index in 0..scans {
        let (found_votes, expected_votes) = (&found.votes[index], &expected.votes[index]);
        assert_eq!(found_votes.0.stamp.counter, index as u64);
        assert_eq!(found_votes.1, expected_votes.1, "scan {index}");
        assert_eq!(found_votes.0.total, expected_votes.0.total);
        let ((header, poses), (expected_header, expected_poses)) =
            (&found.hypotheses[index], &expected.hypotheses[index]);
        assert_eq!(header.verdict, expected_header.verdict, "scan {index}");
        assert_eq!(poses, expected_poses, "scan {index}");
    }
}

#[test]
fn poses_by_an_lms2xx_are_those_of_a_replay() {
    the_graph_answers_as_to_a_replay("lmsposes", &Cable::Serial, as_lms2xx);
}

#[test]
fn poses_by_cola_b_are_those_of_a_replay() {
    the_graph_answers_as_to_a_replay("colabposes", &Cable::Tcp("cola-b"), as_cola);
}

#[test]
fn lms2xx_on_a_serial_line() {
    // 80 m in steps of a centimetre.
    let sound = every_scan_arrives("lms", &Cable::Serial, 0.01);
    nothing_wrong_gets_through("lmsfaults", &Cable::Serial, &sound);
}

#[test]
fn cola_b_on_a_socket() {
    // 80 m in steps of two millimetres, so that 16 bits suffice.
    let sound = every_scan_arrives("colab", &Cable::Tcp("cola-b"), 0.002);
    nothing_wrong_gets_through("colabfaults", &Cable::Tcp("cola-b"), &sound);
}

#[test]
fn cola_a_on_a_socket() {
    every_scan_arrives("colaa", &Cable::Tcp("cola-a"), 0.002);
}

#[test]
fn devices_that_count_their_angles_otherwise() {
    for (tag, name) in [
        ("tim240", "TiM240"),
        ("nav310", "NAV310"),
        ("lrs4000", "LRS4000"),
    ] {
        every_scan_arrives(tag, &Cable::Device(name), 0.002);
    }
}
