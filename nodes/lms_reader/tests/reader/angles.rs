//! Devices with other zero angles and turning directions, as captures and over TCP.
use std::io::Write;

use messages::topic;
use sick::cola::{Channel, Channels, LmdScanData, Telegram};
use transport::testing::{Isolated, wait_until};

use crate::{accept, framed, ident, listen, start};

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

/// Rounds to single precision, as in recordings.
fn radians(deg: f64) -> f64 {
    f64::from(deg.to_radians() as f32)
}

#[test]
fn a_capture_of_a_tim240_without_its_name_is_refused_and_with_it_read() {
    let isolated = Isolated::new("tim");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("capture.bin");
    let play = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let capture = ["--capture", path.to_str().unwrap(), "--rate", "max"];
        start(&graph, &capture)
    };
    let telegram = scan(-120, 241);
    let (status, log) = play(&telegram).finish();
    assert_eq!(status.code(), Some(1), "{log}");
    assert!(scans.receive().unwrap().is_none(), "{log}");
    for part in ["--device NAME", "--zero-deg DEGREES", "--clockwise"] {
        assert!(log.contains(part), "{log}");
    }
    assert!(log.contains("-120° to 120°"), "{log}");
    let named = framed(&Telegram::Answer(ident("TIM2xx")));
    let node = play(&[named, telegram].concat());
    wait_until(&graph, &scans, |header, ranges| {
        assert_eq!(header.angle_min, radians(-120.0));
        assert_eq!((ranges.len(), ranges[0], ranges[240]), (241, 1.0, 1.24));
        true
    });
    let (_, log) = node.finish();
    assert!(log.contains("TiM2xx") && log.contains("issue 478"), "{log}");
}

#[test]
fn a_device_says_its_name_before_its_scans_count() {
    let isolated = Isolated::new("named");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let (listener, address) = listen();
    let node = start(&graph, &["--tcp", &address]);
    // Half of the field, with its middle where most devices have ahead: without the name the usual
    // convention would be assumed.
    let half = scan(0, 181);
    let mut stream = accept(&listener, Some("TiM240"), &half);
    stream.write_all(&half).unwrap();
    wait_until(&graph, &scans, |header, _| {
        assert_eq!((header.angle_min, header.stamp.counter), (0.0, 0));
        true
    });
    node.stop();
}
