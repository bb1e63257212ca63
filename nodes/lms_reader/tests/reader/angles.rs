//! Devices with other zero angles and turning directions, as captures and over TCP.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};

use messages::{NodeState, ScanHeader, topic};
use sick::cola::{
    Answer, Channel, Channels, Command, Encoding, Framer, LmdScanData, Telegram, Value, Variable,
};
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_for_health, wait_until};

use crate::listen;

/// Returns a scan with a reading per degree: the first one, at `first_deg`, is 1 m, and each
/// further one is a millimetre longer.
fn scan(first_deg: i32, beams: u16) -> Vec<u8> {
    let values: Vec<u16> = (1000..1000 + beams).collect();
    let channels = [Channel {
        name: *b"DIST1",
        scale_factor: 1.0,
        scale_offset: 0.0,
        start_angle_raw_1e4_deg: first_deg * 10_000,
        step_raw_1e4_deg: 10_000,
        values: values[..].into(),
    }];
    let data = LmdScanData {
        version: 1,
        device_number: 1,
        serial_number: 1,
        scan_frequency_raw_1e2_hz: 1500,
        channels_16_bit: Channels::from(&channels[..]),
        ..LmdScanData::default()
    };
    framed(&Telegram::ScanData(data))
}

fn framed(telegram: &Telegram<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    Encoding::Binary.frame(telegram, &mut bytes);
    bytes
}

fn ident(name: &str) -> Vec<u8> {
    framed(&Telegram::Answer(Answer::Value(Value::DeviceIdent {
        name: name.as_bytes(),
        version: b"V1.0",
    })))
}

/// Graph, and a folder for a capture.
struct Bench {
    isolated: Isolated,
    folder: tempfile::TempDir,
}

impl Bench {
    fn new(tag: &str) -> Self {
        Bench {
            isolated: Isolated::new(tag),
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn capture(&self, bytes: &[u8]) -> PathBuf {
        let path = self.folder.path().join("capture.bin");
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Returns the first scan of a capture that is played in a loop, and the log.
    fn first(&self, bytes: &[u8], options: &[&str]) -> (ScanHeader, Vec<f32>, String) {
        let graph = self.isolated.join("test");
        let scans = graph.subscriber::<topic::Scan>().unwrap();
        let node = start(
            &graph,
            &self.capture(bytes),
            &[&["--loop"], options].concat(),
        );
        let mut first = None;
        wait_until(&graph, &scans, |header, ranges| {
            first = Some((*header, ranges.to_vec()));
            true
        });
        let log = node.stop_with_log();
        let (header, ranges) = first.unwrap();
        (header, ranges, log)
    }

    /// Returns the log of a capture without usable scans.
    fn refusal(&self, bytes: &[u8], options: &[&str]) -> String {
        let graph = self.isolated.join("test");
        let scans = graph.subscriber::<topic::Scan>().unwrap();
        let node = start(&graph, &self.capture(bytes), options);
        let (status, log) = node.finish();
        assert_eq!(status.code(), Some(1), "{log}");
        assert!(scans.receive().unwrap().is_none(), "{log}");
        log
    }
}

fn start(graph: &Graph, capture: &Path, options: &[&str]) -> NodeProcess {
    let capture = ["--capture", capture.to_str().unwrap(), "--rate", "max"];
    let arguments = [&capture[..], options].concat();
    NodeProcess::start(env!("CARGO_BIN_EXE_lms_reader"), graph, &arguments)
}

/// Rounds to single precision, as in recordings.
fn radians(deg: f64) -> f64 {
    f64::from(deg.to_radians() as f32)
}

fn says_what_to_state(text: &str) {
    for part in ["--device NAME", "--zero-deg DEGREES", "--clockwise"] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_tim240_without_a_name_is_refused_and_with_one_read() {
    let telegram = scan(-120, 241);
    let log = Bench::new("tim0").refusal(&telegram, &[]);
    says_what_to_state(&log);
    assert!(log.contains("-120° to 120°"), "{log}");
    for (tag, options) in [
        ("tim1", &["--device", "TiM240"][..]),
        ("tim2", &["--zero-deg", "0"]),
    ] {
        let (header, ranges, log) = Bench::new(tag).first(&telegram, options);
        assert_eq!(header.angle_min, radians(-120.0), "{log}");
        assert_eq!((ranges.len(), ranges[0], ranges[240]), (241, 1.0, 1.24));
        assert!(log.contains("0° is ahead"), "{log}");
    }
    // The capture includes the device's answer with its name.
    let named = [ident("TIM2xx"), telegram].concat();
    let (header, _, log) = Bench::new("tim3").first(&named, &[]);
    assert_eq!(header.angle_min, radians(-120.0));
    assert!(log.contains("TiM2xx") && log.contains("issue 478"), "{log}");
}

/// Accepts the node's connection; sends `early` at once, the name on request, and `late` when asked
/// to send scans.
fn device(listener: &TcpListener, name: &str, early: &[u8], late: &[u8]) -> TcpStream {
    let (mut stream, _) = listener.accept().unwrap();
    stream.write_all(early).unwrap();
    let mut framer = Framer::new(Encoding::Binary);
    let mut piece = [0; 1000];
    loop {
        let count = stream.read(&mut piece).unwrap();
        assert!(count > 0, "the node has gone");
        framer.push(&piece[..count]);
        while let Some(next) = framer.next_frame() {
            let answer = match next.unwrap().telegram {
                Telegram::Command(Command::Read(Variable::DeviceIdent)) => ident(name),
                Telegram::Command(Command::SubscribeScans(true)) => {
                    let yes = framed(&Telegram::Answer(Answer::ScansSubscribed(true)));
                    stream.write_all(&[&yes, late].concat()).unwrap();
                    return stream;
                }
                _ => framed(&Telegram::Answer(Answer::Value(Value::DeviceState(1)))),
            };
            stream.write_all(&answer).unwrap();
        }
    }
}

#[test]
fn a_device_says_its_name_before_its_scans_count() {
    let isolated = Isolated::new("named");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let (listener, address) = listen();
    let arguments = ["--tcp", &address];
    let node = NodeProcess::start(env!("CARGO_BIN_EXE_lms_reader"), &graph, arguments);
    // Half of the field, with its middle where most devices have ahead: without the name the usual
    // convention would be assumed.
    let half = scan(0, 181);
    let _stream = device(&listener, "TiM240", &half, &half);
    wait_until(&graph, &scans, |header, _| {
        assert_eq!((header.angle_min, header.stamp.counter), (0.0, 0));
        true
    });
    node.stop();
}

#[test]
fn health_says_what_to_state() {
    let isolated = Isolated::new("unnamed");
    let graph = isolated.join("test");
    let health = graph.subscriber::<topic::Health>().unwrap();
    let (listener, address) = listen();
    let arguments = ["--tcp", &address];
    let node = NodeProcess::start(env!("CARGO_BIN_EXE_lms_reader"), &graph, arguments);
    let _stream = device(&listener, "XY7", &[], &scan(-120, 241));
    let (report, reason) = wait_for_health(&graph, &health, |report| {
        report.refused == 1 && report.state == NodeState::Degraded as u32
    });
    assert_eq!(report.sent, 0);
    says_what_to_state(&reason);
    node.stop();
}
