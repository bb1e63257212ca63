//! Tests of the node as a process: with a capture, and with a simulated device on the network.
use std::io::Write;

use messages::{NodeState, topic};
use transport::testing::{Isolated, wait_for_health, wait_until};

use crate::{accept, listen, start};

const CAPTURE: &[u8] =
    include_bytes!("../../../../common/sick/tests/data/tim781_colab_telegrams.bin");
const CAPTURE_PATH: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../common/sick/tests/data/tim781_colab_telegrams.bin"
);
const TELEGRAM: usize = 3374;

#[test]
fn a_capture_is_played_over_and_over_at_the_pace_of_the_device() {
    let isolated = Isolated::new("loop");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let options = ["--loop", "--mount", "0.2,0,90", "--range-max-m", "25"];
    let node = start(
        &graph,
        &[&["--capture", CAPTURE_PATH][..], &options].concat(),
    );
    let mut first = None;
    wait_until(&graph, &scans, |header, ranges| {
        assert_eq!((ranges.len(), header.frame.as_str()), (811, "laser"));
        assert_eq!((header.base_from_laser.x, header.mount_known), (0.2, 1));
        assert_eq!(header.range_max_m, 25.0);
        let stamp = header.stamp;
        let &mut from = first.get_or_insert(stamp);
        let steps = (stamp.counter - from.counter) as i64;
        // The device turns at 15 Hz, and the node never plays early; the first scan may have been
        // up to one step late.
        assert!(stamp.entered_ns - from.entered_ns >= (steps - 1) * 66_000_000);
        // The file has sixteen scans, so this one is from the second round.
        stamp.counter >= 17
    });
    node.stop();
}

#[test]
fn the_last_scans_of_a_capture_wait_for_a_subscriber_that_is_late() {
    let isolated = Isolated::new("tail");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    let node = start(&graph, &["--capture", CAPTURE_PATH, "--rate", "max"]);
    // No one reads the scans until all have been sent.
    wait_for_health(&graph, &health, |report| report.sent == 16);
    let taken = std::iter::from_fn(|| scans.receive().unwrap());
    let counters: Vec<u64> = taken.map(|scan| scan.header().stamp.counter).collect();
    let kept: Vec<u64> = (8..16).collect();
    assert_eq!(counters, kept, "as many as a subscriber keeps");
    let (status, log) = node.finish();
    assert!(status.success(), "{log}");
    assert!(!log.contains("not all subscribers"), "{log}");
}

#[test]
fn a_file_without_scans_is_an_error_that_names_it() {
    let isolated = Isolated::new("empty");
    let graph = isolated.join("test");
    let node = start(&graph, &["--capture", file!(), "--loop"]);
    assert_eq!(node.exit_code(), Some(1));
    let (status, log) = start(&graph, &["--capture", "/nowhere/at/all.bin"]).finish();
    assert_eq!(status.code(), Some(1));
    assert!(
        log.contains("/nowhere/at/all.bin: cannot read the capture"),
        "{log}"
    );
}

#[test]
fn a_device_that_goes_and_comes_back() {
    let isolated = Isolated::new("device");
    let graph = isolated.join("test");
    let scans = graph.subscriber::<topic::Scan>().unwrap();
    let health = graph.subscriber::<topic::Health>().unwrap();
    let (listener, address) = listen();
    let node = start(&graph, &["--tcp", &address]);

    let mut stream = accept(&listener, None, &[]);
    // Pieces that split telegrams at arbitrary places.
    for piece in CAPTURE[..2 * TELEGRAM].chunks(1000) {
        stream.write_all(piece).unwrap();
    }
    wait_until(&graph, &scans, |header, _| header.stamp.counter == 1);
    drop(stream);
    let (_, reason) = wait_for_health(&graph, &health, |header| {
        header.state == NodeState::Degraded as u32
    });
    assert!(reason.contains(&address), "{reason}");
    assert!(reason.contains("closed the connection"), "{reason}");

    let mut stream = accept(&listener, None, &[]);
    stream.write_all(&CAPTURE[..TELEGRAM]).unwrap();
    wait_until(&graph, &scans, |header, _| header.stamp.counter == 2);
    wait_for_health(&graph, &health, |header| {
        header.state == NodeState::Ready as u32
    });

    node.stop();
}

#[test]
fn a_device_that_is_not_there_does_not_hold_up_a_stop() {
    let isolated = Isolated::new("refused");
    let graph = isolated.join("test");
    let health = graph.subscriber::<topic::Health>().unwrap();
    let (listener, address) = listen();
    drop(listener);
    let node = start(&graph, &["--tcp", &address]);
    wait_until(&graph, &health, |header, error| {
        let reason = String::from_utf8_lossy(error);
        header.state == NodeState::Degraded as u32 && reason.contains("refused")
    });
    let log = node.stop_with_log();
    assert_eq!(log.matches("cannot connect").count(), 1, "{log}");
}

#[test]
fn a_silent_device_is_given_up_and_tried_again() {
    let isolated = Isolated::new("silent");
    let graph = isolated.join("test");
    let (listener, address) = listen();
    let node = start(&graph, &["--tcp", &address, "--silence", "0.2"]);
    let _silent = accept(&listener, None, &[]);
    let _again = accept(&listener, None, &[]);
    let log = node.stop_with_log();
    assert!(log.contains("no data for 0.2 s"), "{log}");
}
