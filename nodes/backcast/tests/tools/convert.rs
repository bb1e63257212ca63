//! Tests of `backcast convert` as a process, with short logs of CARMEN.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::{Kind, Message, Recording};
use ros::LaserScan;
use tempfile::TempDir;
use tests::assert_ends;

use crate::drawn::{backcast, folder, run};

#[test]
fn a_destination_that_exists_or_is_no_recording_is_refused() {
    let folder = log_folder();
    let convert = |arguments: &str| run(folder.path(), &format!("convert {arguments}"));
    assert_ends(convert("a.log a.mcap"), 0, "3 scans, 3 poses of");
    let scans = scans(&folder.path().join("a.mcap"));
    assert!(scans.iter().all(|scan| scan.ranges == [2.5; 361]));
    assert_ends(convert("a.log a.mcap"), 2, "a.mcap is there already");
    assert_eq!(convert("a.log new/folder/a.mcap").0, 0);
    assert_eq!(convert("a.log a.mcap --force").0, 0);
    assert_eq!(convert("- b.mcap").0, 2, "a pipe cannot be read twice");
    for to in ["c.bag", "c.log", "c.mcap.gz"] {
        assert_eq!(convert(&format!("a.log {to}")).0, 2, "{to}");
    }
}

#[test]
fn what_is_interrupted_leaves_no_file() {
    let folder = log_folder();
    let log = fs::read_to_string(folder.path().join("a.log")).unwrap();
    // Takes far longer to convert than to interrupt.
    fs::write(folder.path().join("long.log"), log.repeat(12_000)).unwrap();
    let mut convert = backcast(folder.path(), "convert long.log a.mcap");
    let mut child = convert.spawn().unwrap();
    let file = folder.path().join("a.mcap");
    while !file.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::yield_now();
    }
    kill(Pid::from_raw(child.id().cast_signed()), Signal::SIGINT).unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert!(!file.exists());
}

fn scans(file: &Path) -> Vec<LaserScan> {
    let recording = Recording::open(file).unwrap();
    let records = recording.records_of(&[Kind::Scan]);
    let records = records.map(Result::unwrap);
    let scans = records.filter_map(|record| match record.message {
        _ if &*record.topic != "/scan" => None,
        Message::Scan(scan) => Some(scan),
        other => panic!("asked for scans: {other:?}"),
    });
    scans.collect()
}

/// Creates a folder with `a.log`, a log of three scans of a robot that stands.
fn log_folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let ranges = "2.5 ".repeat(361);
    let line = |second| format!("FLASER 361 {ranges}1 2 0.5 1 2 0.5 {second} h {second}\n");
    let lines = [1, 2, 3].map(line);
    fs::write(folder.path().join("a.log"), lines.concat()).unwrap();
    folder
}

#[test]
fn another_laser_has_its_topic_and_what_is_left_out_is_named() {
    let folder = log_folder();
    let mut log = fs::read_to_string(folder.path().join("a.log")).unwrap();
    log += "FLASER 361 1.0 2.0\nTRUEPOS 1 2 3 4 5 6 7 h 7\nTRUEPOS 1 2 3 4 5 6 8 h 8\n";
    log += "PARAM robot_rearlaser_offset -0.4 nohost 0\n";
    log += "RAWLASER2 0 -1.570796 3.141593 1.570796 81.9 0.01 0 3 1.0 2.0 3.0 0 9 h 9\n";
    fs::write(folder.path().join("b.log"), log).unwrap();
    let (code, _, said) = run(folder.path(), "convert b.log b.mcap");
    assert_eq!(code, 3, "{said}");
    for part in [
        "left out: TRUEPOS (2), FLASER cut short (1)",
        "FLASER: of 361 readings 2 are there",
        "/scan_rear holds RAWLASER2",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let converted = folder.path().join("b.mcap");
    assert_eq!(scans(&converted).len(), 3);
    let recording = Recording::open(converted).unwrap();
    let rear = recording.base_from_laser("laser_rear").unwrap().unwrap();
    assert_eq!(rear.base_from_laser.x, -0.4);
}

#[test]
fn where_nothing_can_be_converted_no_file_is_left() {
    let folder = folder(&[]);
    for (content, reason) in [
        ("", "it is empty"),
        ("hello\n", "what no log of CARMEN has (1)"),
        ("ODOM 1 2 3 0 0 0 1.0 h 1\n", "1 poses of the odometry"),
        ("TRUEPOS 1 2 3 4 5 6 7 h 7\n", "TRUEPOS (1)"),
        ("FLASER 9 1.0\n", "FLASER cut short (1)"),
    ] {
        fs::write(folder.path().join("b.log"), content).unwrap();
        let (code, _, said) = run(folder.path(), "convert b.log b.mcap");
        let is_named = said.contains(reason) && said.contains("no file was written");
        assert!(code == 1 && is_named, "{said}");
        assert!(!folder.path().join("b.mcap").exists(), "{content:?}");
    }
    // A recording is no source.
    let (code, _, said) = run(folder.path(), "convert r.mcap c.log");
    assert_eq!(code, 2, "{said}");
    assert!(!folder.path().join("c.log").exists(), "{said}");
    // An unsupported kind of file is reported by the reader of recordings.
    fs::write(folder.path().join("drive.bag"), "#ROSBAG V2.0\nrest").unwrap();
    for (file, reason) in [
        ("drive.bag", "drive.bag"),
        ("none.log", "cannot read none.log"),
    ] {
        assert_ends(
            run(folder.path(), &format!("convert {file} b.mcap")),
            1,
            reason,
        );
    }
}
