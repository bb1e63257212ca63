//! Tests of `backcast info` and `doctor` as processes.

use std::fs;

use recording::Message;
use serde_json::Value;

use crate::drawn::{
    HERE, THERE, folder, framed_map, map_message, mount_message, odometry_at, recordings, run,
    scan, scan_at, truth_at,
};

fn sound() -> tempfile::TempDir {
    folder(&[
        framed_map(),
        mount_message(),
        odometry_at(1, HERE),
        scan_at(1, HERE),
        truth_at(1, HERE),
        odometry_at(2, THERE),
        scan_at(2, THERE),
        truth_at(2, THERE),
    ])
}

fn elsewhere((topic, mut message): (&'static str, Message)) -> (&'static str, Message) {
    if let Message::PoseStamped(pose) = &mut message {
        pose.header.frame_id = "world".to_owned();
    }
    (topic, message)
}

/// Returns the severities and findings of `doctor --json`.
fn findings(folder: &std::path::Path, expected_code: i32) -> Vec<(String, String)> {
    let (code, stdout, stderr) = run(folder, "doctor --json r.mcap");
    assert_eq!((code, stderr.as_str()), (expected_code, ""), "{stdout}");
    let report: Value = serde_json::from_str(&stdout).unwrap();
    let findings = report["findings"].as_array().unwrap().iter();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    findings
        .map(|f| (text(&f["severity"]), text(&f["finding"])))
        .collect()
}

#[test]
fn info_lists_what_is_there() {
    let folder = sound();
    let (code, stdout, _) = run(folder.path(), "info r.mcap");
    assert_eq!(code, 0);
    for part in [
        "r.mcap: ",
        "8 messages in 1 chunks",
        "7.0 s long",
        "nav_msgs/msg/OccupancyGrid",
    ] {
        assert!(stdout.contains(part), "{part}: {stdout}");
    }
    let (_, stdout, _) = run(folder.path(), "info --json r.mcap");
    let object: Value = serde_json::from_str(&stdout).unwrap();
    let taken = [("map", "/map"), ("odometry", "/odom"), ("scans", "/scan")];
    for (what, topic) in taken {
        assert_eq!(object["taken"][what], topic);
    }
    let channels = object["channels"].as_array().unwrap();
    let scan = channels
        .iter()
        .find(|channel| channel["topic"] == "/scan")
        .unwrap();
    assert_eq!(
        (scan["messages"].as_u64(), scan["schema"].as_str()),
        (Some(2), Some("sensor_msgs/msg/LaserScan"))
    );
}

#[test]
fn a_sound_recording_has_no_findings() {
    let folder = sound();
    assert_eq!(findings(folder.path(), 0), []);
    for name in ["malaga_corridor", "malaga_courtyard", "malaga_campus"] {
        let path = recordings().join(name).join("recording.mcap");
        let (code, stdout, _) = run(folder.path(), &format!("doctor {}", path.display()));
        assert_eq!(code, 0, "{stdout}");
        assert!(stdout.ends_with(": sound\n"), "{stdout}");
    }
}

#[test]
fn a_bad_file_of_several_is_named_and_the_others_follow() {
    let folder = sound();
    fs::write(folder.path().join("bad.mcap"), "").unwrap();
    for (command, end) in [("info", "taken: "), ("doctor", "r.mcap: sound\n")] {
        let (code, stdout, stderr) = run(
            folder.path(),
            &format!("{command} nowhere.mcap bad.mcap r.mcap"),
        );
        assert_eq!(code, 1, "{stderr}");
        assert!(stdout.contains(end), "{command}: {stdout}");
        let bad = stderr.contains("bad.mcap: the file starts with nothing, as it is empty");
        assert!(bad && stderr.contains("nowhere.mcap"), "{stderr}");
    }
}

#[test]
fn what_is_lost_ends_with_three() {
    let folder = sound();
    let path = folder.path().join("r.mcap");
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 40]).unwrap();
    let found = findings(folder.path(), 3);
    assert_eq!(found[0].0, "lost");
    assert!(found[0].1.contains("cut short"), "{found:?}");
    let (code, stdout, _) = run(folder.path(), "info r.mcap");
    assert_eq!(code, 3);
    assert!(
        stdout.contains("damaged: the file is cut short"),
        "{stdout}"
    );
    let mut flipped = bytes;
    flipped[300] ^= 4;
    fs::write(&path, flipped).unwrap();
    assert_eq!(findings(folder.path(), 3)[0].0, "lost");
    fs::write(&path, "no recording").unwrap();
    let (code, _, stderr) = run(folder.path(), "doctor r.mcap");
    assert_eq!(code, 1);
    assert!(stderr.contains("the file starts with"), "{stderr}");
}

#[test]
fn what_will_not_work_is_a_problem() {
    let finds = |messages: &[(&str, Message)], code: i32, severity: &str, part: &str| {
        let folder = folder(messages);
        let found = findings(folder.path(), code);
        let is_meant = |(s, f): &(String, String)| s == severity && f.contains(part);
        assert!(found.iter().any(is_meant), "{part}: {found:?}");
    };
    finds(&[framed_map()], 1, "problem", "no laser scans");
    finds(
        &[map_message()],
        1,
        "problem",
        "/map: a message names no frame",
    );
    let elsewhere = [framed_map(), scan_at(1, HERE), elsewhere(truth_at(1, HERE))];
    finds(
        &elsewhere,
        1,
        "problem",
        "is in frame \"world\", the map in \"map\"",
    );
    finds(&[scan_at(1, HERE)], 0, "note", "no map");
    finds(
        &[scan_at(1, HERE)],
        0,
        "note",
        "/tf_static does not say where \"laser\" sits",
    );
    let back = [scan_at(2, HERE), scan_at(1, HERE)];
    finds(&back, 1, "problem", "/scan: stamps go back 1 times");
    let twice = [scan_at(1, HERE), scan_at(1, HERE)];
    finds(&twice, 1, "problem", "1 scans have the stamp before");
    finds(
        &[scan_at(1, HERE), truth_at(2, HERE)],
        0,
        "note",
        "1 of 1 true poses",
    );
    let mut odd = scan(1, HERE);
    odd.ranges.truncate(100);
    let odd = [("/scan", Message::Scan(odd))];
    finds(
        &odd,
        1,
        "problem",
        "1 odd scans; of the first its 100 beams",
    );
    let mut nameless = scan(1, HERE);
    nameless.header.frame_id.clear();
    finds(
        &[("/scan", Message::Scan(nameless))],
        1,
        "problem",
        "names no frame",
    );
    let mut other = scan(2, HERE);
    other.header.frame_id = "rear".to_owned();
    let several = [scan_at(1, HERE), ("/scan", Message::Scan(other))];
    finds(&several, 1, "problem", "several frames, laser, rear");
    let gap: Vec<_> = [1, 2, 3, 30]
        .into_iter()
        .map(|second| scan_at(second, HERE))
        .collect();
    finds(
        &gap,
        0,
        "note",
        "1 gaps, the longest of 27.00 s where 1.00 s is usual",
    );
    let two = [
        ("/a", Message::Scan(scan(1, HERE))),
        ("/b", Message::Scan(scan(1, HERE))),
    ];
    finds(&two, 1, "problem", "several channels");
}
