//! A drawn room, simulated scans in it, and recordings of them.

#![allow(
    clippy::unwrap_used,
    dead_code,
    reason = "a test fails by panicking; each file of tests uses its part"
)]

use std::path::Path;
use std::process::{Command, Stdio};

use geometry::Pose;
use map::OccupancyGrid;
use recording::Message;
use recording::write::{Packing, RecordingWriter};
use ros::{LaserScan, OccupancyGridMsg};
use serde_json::Value;
use tempfile::TempDir;
use tests::drawn_room::{FRAME, occupancy, ranges};
use tests::{assert_ends, said_by};

/// An L-shaped room with a pillar, in which no two poses look alike.
const ROOM: [&str; 12] = [
    "#########...........",
    "#.......#...........",
    "#..#....#...........",
    "#.......#...........",
    "#.......#...........",
    "#.......############",
    "#..................#",
    "#...........##.....#",
    "#...........##.....#",
    "#..................#",
    "#..................#",
    "####################",
];

pub(crate) const RESOLUTION_M: f64 = FRAME.resolution_m;
pub(crate) const BASE_FROM_LASER: Pose = Pose::new(0.5, 0.0, 0.25);
/// Offset from the yaw of the odometry to the heading in the map, degrees.
pub(crate) const ODOMETRY_OFFSET_DEG: f64 = 30.0;
pub(crate) const SECOND_NS: i64 = 1_000_000_000;

/// Column, row and heading in degrees, in the grid's frame.
pub(crate) type Place = (i64, i64, usize);

pub(crate) const HERE: Place = (5, 3, 40);
pub(crate) const THERE: Place = (14, 1, 200);

pub(crate) fn room() -> OccupancyGrid {
    let (width, height) = (ROOM[0].len() as u32, ROOM.len() as u32);
    let cells = occupancy(&ROOM);
    OccupancyGrid::from_parts(width, height, RESOLUTION_M, FRAME.map_from_grid, cells).unwrap()
}

/// Returns the true pose of the laser at the centre of a cell.
pub(crate) fn map_from_laser((x, y, heading): Place) -> Pose {
    let heading = (heading as f64).to_radians();
    FRAME.map_from_cells(x as f64 + 0.5, y as f64 + 0.5, heading)
}

/// Returns the scan of a laser with one beam per degree all around, without noise.
pub(crate) fn scan(second: i32, (x, y, heading): Place) -> LaserScan {
    LaserScan {
        header: header(second, "laser"),
        angle_min: -std::f32::consts::PI,
        angle_max: 179f32.to_radians(),
        angle_increment: 1f32.to_radians(),
        range_max: 30.0,
        ranges: ranges(&ROOM, x, y, heading),
        ..LaserScan::default()
    }
}

pub(crate) fn scan_at(second: i32, place: Place) -> (&'static str, Message) {
    ("/scan", Message::Scan(scan(second, place)))
}

pub(crate) fn map_message() -> (&'static str, Message) {
    ("/map", Message::Map(OccupancyGridMsg::from_grid(&room())))
}

/// Returns the map with a frame name, which `doctor` requires.
pub(crate) fn framed_map() -> (&'static str, Message) {
    let mut map = OccupancyGridMsg::from_grid(&room());
    map.header.frame_id = "map".to_owned();
    ("/map", Message::Map(map))
}

pub(crate) fn truth_at(second: i32, place: Place) -> (&'static str, Message) {
    let message = ros::PoseStamped {
        header: header(second, "map"),
        pose: ros::Pose::from_planar(map_from_laser(place)),
    };
    ("/ground_truth", Message::PoseStamped(message))
}

/// Returns odometry of the base, which is rotated relative to the laser.
pub(crate) fn odometry_at(second: i32, place: Place) -> (&'static str, Message) {
    let offset = ODOMETRY_OFFSET_DEG.to_radians();
    let yaw = map_from_laser(place).yaw - BASE_FROM_LASER.yaw - offset;
    let mut message = ros::Odometry {
        header: header(second, "odom"),
        child_frame_id: "base_link".into(),
        ..ros::Odometry::default()
    };
    message.pose.pose = ros::Pose::from_planar(Pose::new(0.0, 0.0, yaw));
    ("/odom", Message::Odometry(Box::new(message)))
}

pub(crate) fn mount_message() -> (&'static str, Message) {
    let Pose { x, y, yaw } = BASE_FROM_LASER;
    let transform = ros::TransformStamped {
        header: header(0, "base_link"),
        child_frame_id: "laser".into(),
        transform: ros::Transform {
            translation: ros::Vector3 { x, y, z: 0.3 },
            rotation: ros::Quaternion::from_yaw(yaw),
        },
    };
    let transforms = vec![transform];
    let message = Message::StaticTransforms(ros::TfMessage { transforms });
    ("/tf_static", message)
}

fn header(second: i32, frame: &str) -> ros::Header {
    let (sec, nanosec) = (second, 0);
    ros::Header::new(ros::Time { sec, nanosec }, frame)
}

/// Records the messages one second apart.
pub(crate) fn record(path: &Path, messages: &[(&str, Message)]) {
    let mut writer = RecordingWriter::create(path, Packing::Zstd).unwrap();
    for (second, (topic, message)) in (0..).zip(messages) {
        writer.write(topic, second * SECOND_NS, message).unwrap();
    }
    writer.finish().unwrap();
}

pub(crate) fn backcast(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_backcast"));
    command
        .args(shlex::split(arguments).unwrap())
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

pub(crate) fn run(folder: &Path, arguments: &str) -> (i32, String, String) {
    said_by(&mut backcast(folder, arguments))
}

/// Runs a command that succeeds without a remark; returns its output.
#[track_caller]
pub(crate) fn output(folder: &Path, arguments: &str) -> String {
    let (code, stdout, stderr) = run(folder, arguments);
    assert_eq!((code, stderr.as_str()), (0, ""), "{arguments}: {stdout}");
    stdout
}

/// Asserts that a command prints nothing, and its exit code and a part of its error.
#[track_caller]
pub(crate) fn assert_refused(folder: &Path, arguments: &str, code: i32, part: &str) {
    let said = run(folder, arguments);
    assert_eq!(said.1, "", "{arguments}: {}", said.2);
    assert_ends(said, code, part);
}

/// Asserts that a command fails with one line, which has `part`.
#[track_caller]
pub(crate) fn assert_names(folder: &Path, arguments: &str, part: &str) {
    let (code, stdout, stderr) = run(folder, arguments);
    assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
    let is_named = stderr.starts_with("backcast: ") && stderr.contains(part);
    assert!(is_named && stderr.lines().count() == 1, "{part}: {stderr}");
}

/// Returns the objects of an output with one on each line.
pub(crate) fn parsed(output: &str) -> Vec<Value> {
    let lines = output.lines().map(serde_json::from_str);
    lines.map(Result::unwrap).collect()
}

pub(crate) fn recordings() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../recordings"))
}

pub(crate) fn folder(messages: &[(&str, Message)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    record(&folder.path().join("r.mcap"), messages);
    folder
}

/// Creates a folder with a recording that no tool complains about.
pub(crate) fn sound() -> TempDir {
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

/// Locates the scans of `r.mcap`, asserts success, and returns the lines.
pub(crate) fn lines(folder: &Path, options: &str) -> Vec<String> {
    // In a pipe there is no progress bar, and no other output is expected.
    let stdout = output(folder, &format!("locate --bag r.mcap {options}"));
    stdout.lines().map(ToOwned::to_owned).collect()
}

pub(crate) fn objects(folder: &Path, options: &str) -> Vec<Value> {
    parsed(&output(
        folder,
        &format!("locate --bag r.mcap --json {options}"),
    ))
}

pub(crate) fn word(row: &str, column: usize) -> String {
    let word = row.split_whitespace().nth(column);
    word.unwrap().to_owned()
}
