//! A recording through an emulated device and its reader: every scan arrives at the device's
//! resolution, and faults never let a wrong one through.

use std::time::Duration;

use messages::topic;
use tests::executables;
use tests::world::World;
use transport::testing::{Isolated, NodeProcess};
use transport::{Flow, Graph, Subscriber, TransportError};

/// Arguments of device and reader that connect them.
type Cable = [String; 2];

/// Connects them by a socket, with further options; each test has a graph of its own, and each graph
/// an address.
fn socket(device: &str, reader: &str) -> Cable {
    [
        format!("--listen tcp://graph:2112 {device}"),
        format!("--tcp graph:2112 {reader}"),
    ]
}

/// A device and its reader in a graph.
struct Robot {
    emulator: NodeProcess,
    reader: NodeProcess,
    scans: Subscriber<topic::Scan>,
    health: Subscriber<topic::Health>,
    graph: Graph,
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
        let [device, reader] = [0, 1].map(|end| Vec::from_iter(cable[end].split_whitespace()));
        Robot {
            emulator: start("emulator", &[&recording[..], &device, emulator].concat()),
            reader: start("lms_reader", &reader),
            scans,
            health,
            graph,
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

#[test]
fn lms2xx_on_a_serial_line() {
    let folder = tempfile::tempdir().unwrap();
    let line = |name: &str| {
        let link = folder.path().join(name);
        let link = link.display();
        [
            format!("--pty {link} --baud 9600"),
            format!("--serial {link} --baud 500000"),
        ]
    };
    // 80 m in steps of a centimetre.
    let sound = every_scan_arrives("lms", &line("sound"), 0.01);
    nothing_wrong_gets_through("lmsfaults", &line("faulty"), &sound);
}

#[test]
fn cola_b_on_a_socket() {
    // 80 m in steps of two millimetres, so that 16 bits suffice.
    let cable = socket("--protocol cola-b", "--protocol cola-b");
    let sound = every_scan_arrives("colab", &cable, 0.002);
    nothing_wrong_gets_through("colabfaults", &cable, &sound);
}

#[test]
fn cola_a_on_a_socket() {
    let cable = socket("--protocol cola-a", "--protocol cola-a");
    every_scan_arrives("colaa", &cable, 0.002);
}

#[test]
fn devices_that_count_their_angles_otherwise() {
    for (tag, name) in [
        ("tim240", "TiM240"),
        ("nav310", "NAV310"),
        ("lrs4000", "LRS4000"),
    ] {
        // CoLa B, to a device with another convention for angles.
        let cable = socket(&format!("--device {name}"), "");
        every_scan_arrives(tag, &cable, 0.002);
    }
}
