//! Bytes that are no valid message.

use super::*;

#[test]
fn bytes_of_no_meaning_are_refused_and_counted() {
    let Some(mut joined) = join("ros-bad", "/", &[]) else {
        return;
    };
    let health = joined.graph.subscriber::<topic::Health>().unwrap();
    let sound = "0100000000000000010000000000000010000102030405060708090a0b0c0d0e0f";
    let mut refused = 0;
    let mut refuse = |topic: &str, payload: &str, attachment: Option<&str>, expected: &str| {
        let how = json!({ "topic": topic, "payload": payload, "attachment": attachment });
        joined.robot.order("strange", how);
        refused += 1;
        let (report, error) = wait_for_health(&joined.graph, &health, |report| {
            report.node.as_str() == "ros2_gateway" && report.refused >= refused
        });
        assert_eq!(report.refused, refused, "{error}");
        // Of several errors in a second, only the first one is written as text.
        if refused == 1 {
            assert!(error.contains(expected), "{error}");
        }
    };
    refuse("scan", "00010000", Some("00"), "/scan has 1 bytes");
    refuse("scan", "", Some(sound), "less than a CDR header");
    refuse("scan", "00070000ff", None, "representation");
    refuse("odom", &format!("00010000{}", "ff".repeat(700)), None, "");
    refuse(
        "map",
        &format!("00010000{}", "00".repeat(100)),
        Some(sound),
        "",
    );
    refuse(
        "scan",
        &format!("00010000{}", "00".repeat(1 << 21)),
        None,
        "at most",
    );
    // It continues, and takes valid messages.
    let scans_in = joined.graph.subscriber::<topic::Scan>().unwrap();
    joined.robot.order("scan", json!({ "index": 0 }));
    wait_for(&joined.graph, &scans_in, |_, _| Some(()));
    joined.stop();
}
