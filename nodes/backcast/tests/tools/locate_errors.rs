//! Tests of `backcast locate` as a process, on bad scans, bad files and wrong use.

use std::fs;

use recording::Message;
use recording::write::{Packing, RecordingWriter};
use ros::LaserScan;
use serde_json::Value;

use crate::drawn::{
    HERE, assert_names, assert_refused, folder, lines, map_message, objects, room, run, scan,
    scan_at, truth_at, word,
};

#[test]
fn a_refused_scan_has_a_line_with_the_reason() {
    let with = |second, spoil: fn(&mut LaserScan)| {
        let mut scan = scan(second, HERE);
        spoil(&mut scan);
        ("/scan", Message::Scan(scan))
    };
    let folder = folder(&[
        map_message(),
        with(1, |scan| scan.ranges.clear()),
        with(2, |scan| scan.ranges.fill(f32::NAN)),
        with(3, |scan| scan.angle_increment = f32::NAN),
        with(4, |scan| scan.angle_increment = 0.0),
        with(5, |scan| scan.ranges[..300].fill(-1.0)),
        scan_at(6, HERE),
    ]);
    // All beams are used.
    let objects = objects(folder.path(), "--max-beams 360");
    let reason = |i: usize| objects[i]["refused"].as_str().unwrap_or("none");
    assert_eq!(reason(0), "the scan is empty: it has no ranges");
    assert_eq!(reason(1), "none", "nothing returned, which is no fault");
    for (i, start) in [(2, "angle_increment is NaN"), (3, "angle_increment is 0:")] {
        assert!(reason(i).starts_with(start), "{}", reason(i));
    }
    for object in &objects[..4] {
        assert_eq!(object["verdict"], "NoScan");
        assert_eq!(object["hypotheses"], Value::Array(Vec::new()));
    }
    assert_eq!(objects[0]["votes"], Value::Null);
    assert_eq!(objects[1]["votes"]["beams_used"], 0);
    assert_eq!(objects[1]["votes"]["best"], 0);
    assert_eq!(
        objects[4]["votes"]["beams_silent"], 300,
        "a reading below zero is none"
    );
    assert_eq!(objects[5]["verdict"], "Unique");

    let rows = lines(folder.path(), "");
    let (columns, reason) = rows[1].split_at(rows[0].len());
    let dashes = columns.split_whitespace().filter(|word| *word == "-");
    assert_eq!((word(columns, 0), dashes.count()), ("1.000".into(), 4));
    assert_eq!(word(columns, 5), "NoScan");
    assert_eq!(reason, "  the scan is empty: it has no ranges");
    let (_, says) = rows[2].split_at(rows[0].len());
    assert_eq!(says, "  no usable beams: is the laser covered?");
}

#[test]
fn a_scan_that_does_not_decode_is_lost_data() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("r.mcap");
    let mut writer = RecordingWriter::create(path, Packing::Lz4).unwrap();
    let (_, map) = map_message();
    writer.write("/map", 0, &map).unwrap();
    writer.write("/scan", 1, &scan_at(1, HERE).1).unwrap();
    let (schema, text) = ("sensor_msgs/msg/LaserScan", "float32[] ranges");
    let nonsense = [0, 1, 0, 0, 9];
    writer
        .write_bytes("/scan", schema, text, "cdr", 2, &nonsense)
        .unwrap();
    writer.write("/scan", 3, &scan_at(3, HERE).1).unwrap();
    writer.finish().unwrap();
    let (code, stdout, stderr) = run(folder.path(), "locate --json --bag r.mcap");
    assert_eq!((code, stdout.lines().count()), (3, 2), "{stderr}");
    assert!(
        stderr.starts_with("backcast: r.mcap: the message of /scan at log time 2 ns is no"),
        "{stderr}"
    );
}

#[test]
fn what_is_missing_or_broken_is_named() {
    let no_scan = folder(&[map_message(), truth_at(1, HERE)]);
    let no_map = folder(&[scan_at(1, HERE)]);
    let empty = map::OccupancyGrid {
        cells: vec![0; 240],
        ..room()
    };
    map::save(&empty, no_map.path().join("empty.yaml")).unwrap();
    fs::write(no_map.path().join("text.mcap"), "no recording at all").unwrap();
    let map_missing = "r.mcap has no map on /map: name one with --map map.yaml";
    for (folder, options, expected) in [
        (&no_scan, "r.mcap", "no sensor_msgs/msg/LaserScan; it has"),
        (&no_scan, "nowhere.mcap", "nowhere.mcap: No such file"),
        (&no_map, "r.mcap", map_missing),
        (&no_map, "r.mcap --map r.mcap", map_missing),
        (&no_map, "r.mcap --map nowhere.yaml", "nowhere.yaml"),
        (&no_map, "r.mcap --heading-from odometry", "nav_msgs/msg"),
        (&no_map, "r.mcap --map empty.yaml", "no occupied cell"),
        (&no_map, "text.mcap", "text.mcap"),
    ] {
        assert_names(folder.path(), &format!("locate --bag {options}"), expected);
    }
}

#[test]
fn a_recording_that_is_cut_short_gives_what_lies_before() {
    let folder = folder(&[map_message(), scan_at(1, HERE)]);
    let path = folder.path().join("r.mcap");
    let bytes = fs::read(&path).unwrap();
    // Only the end mark is missing: all messages are there.
    fs::write(&path, &bytes[..bytes.len() - 4]).unwrap();
    let (code, stdout, stderr) = run(folder.path(), "locate --json --bag r.mcap");
    assert_eq!((code, stdout.lines().count()), (1, 1), "{stderr}");
    assert!(stderr.contains("r.mcap: the file is cut short"), "{stderr}");
    // Cut within the only chunk: the damage is reported, not missing scans.
    fs::write(&path, &bytes[..200]).unwrap();
    let cut = "r.mcap: the file is cut short";
    assert_refused(folder.path(), "locate --json --bag r.mcap", 1, cut);
}
