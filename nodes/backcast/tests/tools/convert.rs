//! Tests of `backcast convert` as a process, with logs of real robots.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;

use geometry::Pose;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use recording::{Kind, Message, Recording};
use ros::LaserScan;

use crate::drawn::{backcast, folder, recordings, run};

#[test]
fn a_destination_that_exists_or_is_no_recording_is_refused() {
    let corridor = Corridor::new();
    let convert = |arguments: &str| run(corridor.folder.path(), &format!("convert {arguments}"));
    let (code, _, said) = convert("a.log a.mcap");
    assert_eq!(code, 0, "{said}");
    assert!(
        said.contains("37 scans, 37 poses of the odometry"),
        "{said}"
    );
    let (code, _, said) = convert("a.log a.mcap");
    assert_eq!(code, 2, "what exists is kept");
    assert!(said.contains("a.mcap is there already"), "{said}");
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
    let mut child = backcast(corridor.folder.path(), "convert long.log a.mcap")
        .spawn()
        .unwrap();
    let file = corridor.folder.path().join("a.mcap");
    while !file.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::yield_now();
    }
    kill(Pid::from_raw(child.id().cast_signed()), Signal::SIGINT).unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert!(!file.exists());
}

/// Returns the scans on `/scan` of a recording.
fn scans(file: &Path) -> Vec<LaserScan> {
    let recording = Recording::open(file).unwrap();
    let records = recording.records_of(&[Kind::Scan]);
    let scans = records.filter_map(|record| match record.unwrap() {
        record if &*record.topic != "/scan" => None,
        record => match record.message {
            Message::Scan(scan) => Some(*Box::new(scan)),
            other => panic!("asked for scans: {other:?}"),
        },
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
                let poses = [laser, odom_from_base];
                let poses = poses
                    .map(|p| format!("{} {} {}", p.x, p.y, p.yaw))
                    .join(" ");
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

/// The corridor as a log, with the scans that it was made from.
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

    /// Returns the log with the words of each scan changed, after the lines of `head`.
    fn with(&self, head: &str, change: impl Fn(Vec<&str>) -> Vec<String>) -> String {
        let line = |line: &str| match line.starts_with("FLASER ") {
            true => change(line.split(' ').collect()).join(" "),
            false => line.to_owned(),
        };
        let lines: Vec<String> = self.log.lines().map(line).collect();
        format!("{head}\n{}\n", lines.join("\n"))
    }

    /// Converts a file `name` with `content`; returns the messages and the scans.
    fn converted(&self, name: &str, content: &[u8]) -> (String, Vec<LaserScan>) {
        let to = self.folder.path().join("to.mcap");
        fs::write(self.folder.path().join(name), content).unwrap();
        let (code, _, said) = run(self.folder.path(), &format!("convert {name} to.mcap"));
        assert_eq!(code, 0, "{said}");
        let scans = scans(&to);
        fs::remove_file(to).unwrap();
        (said, scans)
    }

    /// Asserts that these are the corridor's scans, each starting at beam `first`.
    fn assert_same(&self, found: &[LaserScan], first: usize, what: &str) {
        assert_eq!(found.len(), self.scans.len(), "{what}");
        for (found, scan) in found.iter().zip(&self.scans) {
            let last = first + found.ranges.len();
            assert_eq!(found.ranges, scan.ranges[first..last], "{what}");
            let start = scan.angle_min + first as f32 * scan.angle_increment;
            // Logs give the step with six digits, and there are 360 steps.
            assert!((found.angle_min - start).abs() < 4e-4, "{what}");
            assert!(
                (found.angle_increment - scan.angle_increment).abs() < 2e-6,
                "{what}"
            );
        }
    }
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Returns the words of an old line with its readings in reverse order.
fn reversed(words: &[&str]) -> Vec<String> {
    let mut words = owned(words);
    let readings = 2..2 + words[1].parse::<usize>().unwrap();
    words[readings].reverse();
    words
}

/// Converts an old line to a raw line.
fn raw(words: &[&str], number: u8, start: f64, step: f64) -> Vec<String> {
    let count: usize = words[1].parse().unwrap();
    let head = format!("RAWLASER{number} 0 {start} 3.141593 {step} 81.9 0.01 0");
    let time = &words[words.len() - 3..];
    [
        &[head],
        &owned(&words[1..count + 2])[..],
        &owned(&["0"]),
        &owned(time),
    ]
    .concat()
}

#[test]
fn a_laser_upside_down_is_turned_about_unless_its_driver_did_so() {
    let corridor = Corridor::new();
    for flipped in ["laser_front_laser_flipped 1", "laser_laser1_flipped on"] {
        let head = format!("PARAM {flipped} nohost 0");
        let log = corridor.with(&head, |words| reversed(&words));
        let (said, scans) = corridor.converted("b.log", log.as_bytes());
        corridor.assert_same(&scans, 0, flipped);
        assert!(
            said.contains("its beams run clockwise, and are turned about"),
            "{said}"
        );
        let log = corridor.with(&head, |words| owned(&words));
        let (said, scans) = corridor.converted("b.log", log.as_bytes());
        corridor.assert_same(&scans, 0, flipped);
        assert!(
            said.contains("before they were logged, and are kept"),
            "{said}"
        );
    }
}

#[test]
fn several_lasers_become_topics_with_their_mounts() {
    let corridor = Corridor::new();
    let rear = corridor.with("PARAM robot_rearlaser_offset -0.4 nohost 0", |words| {
        raw(&words, 2, -FRAC_PI_2, 0.008_727)
    });
    let log = [corridor.log.as_str(), &rear].concat();
    let (code, _, said) = {
        fs::write(corridor.folder.path().join("b.log"), log).unwrap();
        run(corridor.folder.path(), "convert b.log b.mcap")
    };
    assert_eq!(code, 0, "{said}");
    assert!(
        said.contains("/scan_rear holds RAWLASER2: 37 scans"),
        "{said}"
    );
    let recording = Recording::open(corridor.folder.path().join("b.mcap")).unwrap();
    let mount = recording.base_from_laser("laser_rear").unwrap().unwrap();
    // A rear laser looks backwards; the angle passes through a quaternion.
    let back = Pose::new(-0.4, 0.0, PI);
    assert!(
        mount.base_from_laser.is_within(back, 1e-9, 1e-9),
        "{mount:?}"
    );
}

#[test]
fn what_is_left_out_is_counted_and_named() {
    let corridor = Corridor::new();
    let mut log = corridor.log.clone();
    log += "FLASER 361 1.0 2.0\nTRUEPOS 1 2 3 4 5 6 7 h 7\nTRUEPOS 1 2 3 4 5 6 8 h 8\n";
    fs::write(corridor.folder.path().join("b.log"), log).unwrap();
    let (code, _, said) = run(corridor.folder.path(), "convert b.log b.mcap");
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains(
            "left out: 1 FLASER line cut short, 2 lines of kinds that are not converted (2 TRUEPOS)"
        ),
        "{said}"
    );
    assert!(
        said.contains("FLASER: of 361 readings 2 are there"),
        "{said}"
    );
    assert_eq!(scans(&corridor.folder.path().join("b.mcap")).len(), 37);
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
        assert_eq!(code, 1, "{said}");
        assert!(
            said.contains(reason) && said.contains("no file was written"),
            "{said}"
        );
        assert!(!folder.path().join("b.mcap").exists(), "{content:?}");
    }
    // A recording is no source.
    let (code, _, said) = run(folder.path(), "convert r.mcap c.log");
    assert_eq!(code, 2, "{said}");
    assert!(!folder.path().join("c.log").exists(), "{said}");
    // An unsupported kind of file is reported by the reader of recordings.
    fs::write(folder.path().join("drive.bag"), "#ROSBAG V2.0\nrest").unwrap();
    let (code, _, said) = run(folder.path(), "convert drive.bag b.mcap");
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("drive.bag"), "{said}");
    let (code, _, said) = run(folder.path(), "convert none.log b.mcap");
    assert_eq!(code, 1, "{said}");
    assert!(said.contains("cannot read none.log"), "{said}");
}
