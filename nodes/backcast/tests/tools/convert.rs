//! Tests of `backcast convert` as a process, with logs of real robots.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;

use geometry::Pose;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::{Kind, Message, Recording};
use ros::LaserScan;
use tests::assert_ends;

use crate::drawn::{backcast, folder, recordings, run};

#[test]
fn a_destination_that_exists_or_is_no_recording_is_refused() {
    let corridor = Corridor::new();
    let convert = |arguments: &str| run(corridor.folder.path(), &format!("convert {arguments}"));
    assert_ends(convert("a.log a.mcap"), 0, "37 scans, 37 poses of");
    corridor.assert_same("a.mcap");
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
    let corridor = Corridor::new();
    // Takes far longer to convert than to interrupt.
    let long = corridor.log.repeat(500);
    fs::write(corridor.folder.path().join("long.log"), long).unwrap();
    let mut convert = backcast(corridor.folder.path(), "convert long.log a.mcap");
    let mut child = convert.spawn().unwrap();
    let file = corridor.folder.path().join("a.mcap");
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

/// Writes a recording as a log with lines `ODOM` and `FLASER`.
fn log(recording: &Recording) -> String {
    let mut odom_from_base = Pose::IDENTITY;
    let mut log = String::new();
    for record in recording.records_of(&[Kind::Scan, Kind::Odometry]) {
        match record.unwrap().message {
            Message::Odometry(odometry) => {
                odom_from_base = odometry.pose.pose.planar().unwrap();
                let Pose { x, y, yaw } = odom_from_base;
                let time = odometry.header.stamp.as_ns() as f64 / 1e9;
                log += &format!("ODOM {x} {y} {yaw} 0 0 0 {time} host {time}\n");
            }
            Message::Scan(scan) => {
                let mount = recording.base_from_laser(&scan.header.frame_id).unwrap();
                let base_from_laser = mount.map_or(Pose::IDENTITY, |mount| mount.base_from_laser);
                let laser = odom_from_base.then(base_from_laser);
                let pose = |p: Pose| format!("{} {} {}", p.x, p.y, p.yaw);
                let poses = [laser, odom_from_base].map(pose).join(" ");
                let ranges: Vec<String> = scan.ranges.iter().map(f32::to_string).collect();
                let (beams, ranges) = (ranges.len(), ranges.join(" "));
                let time = scan.header.stamp.as_ns() as f64 / 1e9;
                log += &format!("FLASER {beams} {ranges} {poses} {time} host {time}\n");
            }
            _ => {}
        }
    }
    log
}

struct Corridor {
    folder: tempfile::TempDir,
    log: String,
    scans: Vec<LaserScan>,
}

impl Corridor {
    fn new() -> Self {
        let folder = folder(&[]);
        let recording = recordings().join("malaga_corridor/recording.mcap");
        let log = log(&Recording::open(&recording).unwrap());
        fs::write(folder.path().join("a.log"), &log).unwrap();
        Corridor {
            log,
            scans: scans(&recording),
            folder,
        }
    }

    fn assert_same(&self, file: &str) {
        let found = scans(&self.folder.path().join(file));
        assert_eq!(found.len(), self.scans.len());
        for (found, scan) in found.iter().zip(&self.scans) {
            assert_eq!(found.ranges, scan.ranges);
            // Logs give the step with six digits, and there are 360 steps.
            assert!((found.angle_min - scan.angle_min).abs() < 4e-4);
            assert!((found.angle_increment - scan.angle_increment).abs() < 2e-6);
        }
    }
}

#[test]
fn another_laser_has_its_topic_and_what_is_left_out_is_named() {
    let corridor = Corridor::new();
    let mut log = corridor.log.clone();
    log += "FLASER 361 1.0 2.0\nTRUEPOS 1 2 3 4 5 6 7 h 7\nTRUEPOS 1 2 3 4 5 6 8 h 8\n";
    log += "PARAM robot_rearlaser_offset -0.4 nohost 0\n";
    log += "RAWLASER2 0 -1.570796 3.141593 1.570796 81.9 0.01 0 3 1.0 2.0 3.0 0 9 h 9\n";
    fs::write(corridor.folder.path().join("b.log"), log).unwrap();
    let (code, _, said) = run(corridor.folder.path(), "convert b.log b.mcap");
    assert_eq!(code, 3, "{said}");
    for part in [
        "left out: 1 FLASER line cut short, 2 lines of kinds",
        "(2 TRUEPOS)",
        "FLASER: of 361 readings 2 are there",
        "/scan_rear holds RAWLASER2",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let converted = corridor.folder.path().join("b.mcap");
    assert_eq!(scans(&converted).len(), 37);
    let recording = Recording::open(converted).unwrap();
    let rear = recording.base_from_laser("laser_rear").unwrap().unwrap();
    assert_eq!(rear.base_from_laser.x, -0.4);
}

#[test]
fn where_nothing_can_be_converted_no_file_is_left() {
    let folder = folder(&[]);
    for (content, reason) in [
        ("", "it is empty"),
        ("hello\n", "1 line that no log of CARMEN has"),
        ("ODOM 1 2 3 0 0 0 1.0 h 1\n", "1 poses of the odometry"),
        ("TRUEPOS 1 2 3 4 5 6 7 h 7\n", "(1 TRUEPOS)"),
        ("FLASER 9 1.0\n", "1 FLASER line cut short"),
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
