//! Tests of `backcast info` and `doctor` as processes.

use std::fs;

use recording::Message;
use serde_json::Value;

use crate::drawn::{
    HERE, assert_refused, folder, framed_map, map_message, output, parsed, recordings, run, scan,
    scan_at, sound, truth_at,
};

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
    let report = parsed(&stdout).remove(0);
    let findings = report["findings"].as_array().unwrap().iter();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let findings = findings.map(|f| (text(&f["severity"]), text(&f["finding"])));
    findings.collect()
}

#[test]
fn info_lists_what_is_there() {
    let folder = sound();
    let stdout = output(folder.path(), "info r.mcap");
    for part in [
        "r.mcap: ",
        "8 messages in 1 chunks",
        "7.0 s long",
        "nav_msgs/msg/OccupancyGrid",
    ] {
        assert!(stdout.contains(part), "{part}: {stdout}");
    }
    let object = &parsed(&output(folder.path(), "info --json r.mcap"))[0];
    for (what, topic) in [("map", "/map"), ("odometry", "/odom"), ("scans", "/scan")] {
        assert_eq!(object["taken"][what], topic);
    }
    let mut channels = object["channels"].as_array().unwrap().iter();
    let scan = channels
        .find(|channel| channel["topic"] == "/scan")
        .unwrap();
    assert_eq!(scan["messages"], 2);
    assert_eq!(scan["schema"], "sensor_msgs/msg/LaserScan");
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
        let arguments = format!("{command} nowhere.mcap bad.mcap r.mcap");
        let (code, stdout, stderr) = run(folder.path(), &arguments);
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
    let is_said = stdout.contains("damaged: the file is cut short");
    assert!(code == 3 && is_said, "{stdout}");
    let mut flipped = bytes;
    flipped[300] ^= 4;
    fs::write(&path, flipped).unwrap();
    assert_eq!(findings(folder.path(), 3)[0].0, "lost");
    fs::write(&path, "no recording").unwrap();
    assert_refused(folder.path(), "doctor r.mcap", 1, "the file starts with");
}

#[test]
fn what_will_not_work_is_a_problem() {
    let finds = |messages: &[(&str, Message)], severity: &str, part: &str| {
        let folder = folder(messages);
        let found = findings(folder.path(), i32::from(severity == "problem"));
        let is_meant = |(s, f): &(String, String)| s == severity && f.contains(part);
        assert!(found.iter().any(is_meant), "{part}: {found:?}");
    };
    let problem = |messages: &[(&str, Message)], part| finds(messages, "problem", part);
    let note = |messages: &[(&str, Message)], part| finds(messages, "note", part);
    let changed = |second, change: fn(&mut ros::LaserScan)| {
        let mut scan = scan(second, HERE);
        change(&mut scan);
        ("/scan", Message::Scan(scan))
    };
    problem(&[framed_map()], "no laser scans");
    problem(&[map_message()], "/map: a message names no frame");
    let elsewhere = [framed_map(), scan_at(1, HERE), elsewhere(truth_at(1, HERE))];
    problem(&elsewhere, "is in frame \"world\", the map in \"map\"");
    note(&[scan_at(1, HERE)], "no map");
    let no_mount = "/tf_static does not say where \"laser\"";
    note(&[scan_at(1, HERE)], no_mount);
    let back = [scan_at(2, HERE), scan_at(1, HERE)];
    problem(&back, "/scan: stamps go back 1 times");
    let twice = [scan_at(1, HERE), scan_at(1, HERE)];
    problem(&twice, "1 scans have the stamp before");
    note(&[scan_at(1, HERE), truth_at(2, HERE)], "1 of 1 true poses");
    let odd = changed(1, |scan| scan.ranges.truncate(100));
    problem(&[odd], "1 odd scans; of the first its 100 beams");
    let nameless = changed(1, |scan| scan.header.frame_id.clear());
    problem(&[nameless], "names no frame");
    let other = changed(2, |scan| scan.header.frame_id = "rear".to_owned());
    problem(&[scan_at(1, HERE), other], "several frames, laser, rear");
    let gap = [1, 2, 3, 30].map(|second| scan_at(second, HERE));
    note(&gap, "1 gaps, the longest of 27.00 s where 1.00 s is");
    let two = ["/a", "/b"].map(|topic| (topic, Message::Scan(scan(1, HERE))));
    problem(&two, "several channels");
}
