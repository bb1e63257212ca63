//! Recordings from other sources.

use std::fs;

use recording::Message;
use ros::{LaserScan, OccupancyGridMsg};
use serde_json::Value;
use tests::assert_ends;

use crate::drawn::{
    HERE, THERE, assert_refused, folder, framed_map, map_message, mount_message, output, parsed,
    record, recordings, room, run, scan, scan_at, truth_at,
};

/// Returns the map of the room with only the first `rows` rows known.
fn known_rows(rows: usize) -> (&'static str, Message) {
    let mut room = room();
    let width = room.width as usize;
    for cell in &mut room.cells[rows * width..] {
        *cell = map::UNKNOWN;
    }
    ("/map", Message::Map(OccupancyGridMsg::from_grid(&room)))
}

fn verdicts(folder: &std::path::Path, arguments: &str) -> (i32, Vec<String>, String) {
    let (code, stdout, stderr) = run(folder, &format!("locate --json {arguments}"));
    (code, verdicts_in(&stdout), stderr)
}

fn verdicts_in(stdout: &str) -> Vec<String> {
    let verdict = |object: &Value| object["verdict"].as_str().unwrap().to_owned();
    parsed(stdout).iter().map(verdict).collect()
}

/// Asserts that nothing is remarked, and the verdicts.
#[track_caller]
fn assert_verdicts(folder: &std::path::Path, arguments: &str, expected: &[&str]) {
    let stdout = output(folder, &format!("locate --json {arguments}"));
    assert_eq!(verdicts_in(&stdout), expected, "{arguments}");
}

#[test]
fn the_newest_map_before_a_scan_counts() {
    let folder = folder(&[
        known_rows(0),
        scan_at(1, HERE),
        known_rows(2),
        known_rows(12),
        scan_at(2, HERE),
        known_rows(0),
        scan_at(3, THERE),
    ]);
    let (code, found, stderr) = verdicts(folder.path(), "r.mcap");
    assert_eq!(found, ["NoScan", "Unique", "Unique"], "{stderr}");
    assert_eq!(code, 0);
    // The two maps without occupied cells are identical and reported once.
    let note = "backcast: r.mcap: a map is ignored: the map has no occupied cell: there is nothing \
                that a laser could see\n";
    assert_eq!(stderr, note);
    let (_, stdout, _) = run(folder.path(), "locate r.mcap");
    let refused = stdout.lines().nth(1).unwrap();
    let no_map = "r.mcap: no map up to this scan can be searched: the map has no occupied cell: \
                  there is nothing that a laser could see";
    assert!(refused.ends_with(no_map), "{refused}");
}

#[test]
fn a_map_that_is_recorded_behind_all_scans_counts_for_them() {
    let folder = folder(&[scan_at(1, HERE), scan_at(2, THERE), map_message()]);
    assert_verdicts(folder.path(), "r.mcap", &["Unique", "Unique"]);
}

#[test]
fn where_every_scan_is_refused_there_is_an_error() {
    let still = |second| {
        let scan = LaserScan {
            angle_increment: 0.0,
            ..scan(second, HERE)
        };
        ("/scan", Message::Scan(scan))
    };
    let folder = folder(&[map_message(), still(1), truth_at(1, HERE), still(2)]);
    let said = |scans: u32| {
        format!(
            "backcast: r.mcap: every scan was rejected, {scans} in all; the first: angle_increment is 0"
        )
    };
    let (code, found, stderr) = verdicts(folder.path(), "r.mcap");
    assert_eq!((code, found.len()), (1, 2));
    assert!(stderr.starts_with(&said(2)), "{stderr}");
    assert_refused(folder.path(), "evaluate r.mcap", 1, &said(1));
    let (code, stdout, _) = run(folder.path(), "doctor r.mcap");
    let odd = "problem  /scan: 2 odd scans; of the first angle_increment is 0";
    assert!(code == 1 && stdout.contains(odd), "{stdout}");
}

#[test]
fn the_topic_is_named_where_several_could_be_meant() {
    let on = |topic, second, place| (topic, Message::Scan(scan(second, place)));
    let folder = folder(&[
        framed_map(),
        on("/front/scan", 1, HERE),
        on("/rear/scan", 2, THERE),
        on("/front/scan", 3, THERE),
    ]);
    for (topic, scans) in [("/front/scan", 2), ("/rear/scan", 1)] {
        let arguments = format!("r.mcap --scan-topic {topic}");
        assert_verdicts(folder.path(), &arguments, &vec!["Unique"; scans]);
    }
    let several = "/front/scan, /rear/scan, and none is called /scan: name one with --scan-topic\n";
    let wrong = "has no sensor_msgs/msg/LaserScan on /scan; it has /front/scan, /rear/scan\n";
    let unknown = "the pose of laser rear on the base is unknown";
    for (options, said) in [
        ("", several),
        ("--scan-topic /scan", wrong),
        ("--scan-topic /rear/scan --scan-topic /front/scan", unknown),
    ] {
        let located = run(folder.path(), &format!("locate r.mcap {options}"));
        assert_ends(located, 1, said);
    }
    let info = output(folder.path(), "info r.mcap --scan-topic /rear/scan");
    assert!(info.contains("taken: map /map, scans /rear/scan"), "{info}");
    let (code, _, _) = run(folder.path(), "doctor r.mcap --scan-topic /rear/scan");
    assert_eq!(code, 0);
}

#[test]
fn a_map_and_a_recording_that_are_swapped_are_reported() {
    let folder = folder(&[map_message(), scan_at(1, HERE)]);
    map::save(&room(), folder.path().join("room.yaml")).unwrap();
    for bag in ["--bag room.yaml", "room.yaml"] {
        let arguments = format!("locate --json {bag} --map r.mcap");
        let swapped = "room.yaml is a map, and --map r.mcap a recording: the two look swapped\n";
        assert_refused(folder.path(), &arguments, 2, swapped);
    }
    for files in [
        "--bag r.mcap --map room.yaml",
        "room.yaml r.mcap",
        "r.mcap room.yaml",
    ] {
        let (code, found, _) = verdicts(folder.path(), files);
        assert_eq!((code, found), (0, vec!["Unique".to_owned()]), "{files}");
    }
}

#[test]
fn a_folder_stands_wherever_a_recording_does() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("drive");
    fs::create_dir(&bag).unwrap();
    let (scan, truth) = (scan_at(1, HERE), truth_at(1, HERE));
    let first = [map_message(), mount_message(), scan, truth];
    record(&bag.join("drive_0.mcap"), &first);
    let second = [scan_at(2, THERE), truth_at(2, THERE)];
    record(&bag.join("drive_1.mcap"), &second);
    let both = "drive/drive_0.mcap drive/drive_1.mcap";
    for files in ["drive", "--bag drive", both] {
        assert_verdicts(folder.path(), files, &["Unique", "Unique"]);
    }
    let figures = &parsed(&output(folder.path(), "evaluate --json drive"))[0];
    assert_eq!(figures["truths"], 2);
    assert_eq!(figures["unique"], 2);
    let info = output(folder.path(), "info drive");
    let is_whole = info.starts_with("drive: ") && info.contains("6 messages in 2 chunks");
    assert!(is_whole, "{info}");
    output(folder.path(), "plot --bag drive --out scan.png");
    let (code, _, stderr) = run(folder.path(), "convert drive drive.mcap");
    assert_eq!(code, 0, "{stderr}");
    assert_verdicts(folder.path(), "drive.mcap", &["Unique", "Unique"]);
    let corridor = recordings().join("malaga_corridor/map.yaml");
    let map = format!("drive --map {}", corridor.display());
    let (code, found, _) = verdicts(folder.path(), &map);
    assert_eq!((code, found.len()), (0, 2), "the map that is given counts");
}

#[test]
fn a_transform_that_is_none_is_a_note_where_the_laser_does_not_need_it() {
    let broken = |child: &str| {
        let (topic, mut message) = mount_message();
        if let Message::StaticTransforms(message) = &mut message {
            let mut camera = message.transforms[0].clone();
            camera.child_frame_id = child.to_owned();
            camera.transform.translation.x = f64::NAN;
            message.transforms.push(camera);
        }
        (topic, message)
    };
    let camera = folder(&[framed_map(), broken("camera"), scan_at(1, HERE)]);
    let note = "the transform from base_link to camera is ignored: the position (NaN, 0) is not \
                finite\n";
    let (code, found, stderr) = verdicts(camera.path(), "r.mcap");
    assert_eq!((code, found), (0, vec!["Unique".to_owned()]));
    assert_eq!(stderr, format!("backcast: {note}"));
    let (code, stdout, _) = run(camera.path(), "doctor r.mcap");
    assert_eq!((code, stdout), (0, format!("r.mcap:\n  note     {note}")));
}
