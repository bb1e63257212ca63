//! A small recording for this crate's tests: a map, a mount, a few scans with odometry and ground
//! truth in several chunks, and a message of an unknown type.

use std::io::Cursor;

use geometry::Pose;
use map::OccupancyGrid;
use ros::{
    self, Header, LaserScan, OccupancyGridMsg, Odometry, PoseStamped, TfMessage, Time, Transform,
    TransformStamped, Vector3,
};

use crate::write::{Packing, RecordingWriter};
use crate::{GROUND_TRUTH, MAP, Message, ODOM, Record, Recording, SCAN, TF_STATIC};

pub(crate) const SCANS: usize = 6;
pub(crate) const MOUNT: Pose = Pose::new(0.78, 0.1, 0.25);

pub(crate) fn stamp_ns(scan: usize) -> i64 {
    1_137_772_793_000_000_000 + 100_000_000 * scan as i64
}

pub(crate) fn truth(scan: usize) -> Pose {
    Pose::new(1.0 + scan as f64, -2.0, 0.1 * scan as f64)
}

pub(crate) fn grid() -> OccupancyGrid {
    let cells = [0, 100, 255].repeat(20);
    OccupancyGrid::from_parts(10, 6, 0.05, Pose::new(-1.0, 2.0, 0.0), cells).unwrap()
}

/// The decodable messages, by log time, then position in the file.
pub(crate) fn records() -> Vec<Record> {
    let record = |topic: &str, scan: usize, message| Record {
        topic: topic.into(),
        log_time_ns: stamp_ns(scan),
        message,
    };
    let mut records = vec![
        record(MAP, 0, Message::Map(OccupancyGridMsg::from_grid(&grid()))),
        record(TF_STATIC, 0, mount()),
    ];
    for scan in 0..SCANS {
        records.push(record(SCAN, scan, laser_scan(scan)));
        records.push(record(ODOM, scan, odometry(scan)));
        records.push(record(GROUND_TRUTH, scan, true_pose(scan)));
    }
    records
}

/// The file: chunks of four messages, with the second and third swapped, so that the order of the
/// file differs from the order of the times.
pub(crate) fn bytes(packing: Packing) -> Vec<u8> {
    let mut writer = RecordingWriter::in_memory(packing).unwrap();
    let records = records();
    let mut chunks: Vec<&[Record]> = records.chunks(4).collect();
    // The first chunk ends within scan 0, so swapping it would change the order of equal times.
    chunks.swap(1, 2);
    for chunk in chunks {
        for record in chunk {
            let (topic, time) = (&record.topic, record.log_time_ns);
            writer.write(topic, time, &record.message).unwrap();
        }
        writer.flush().unwrap();
    }
    let log = "rcl_interfaces/msg/Log";
    writer
        .write_bytes("/rosout", log, "string msg", "cdr", stamp_ns(1), b"hello")
        .unwrap();
    writer.finish().unwrap().into_inner()
}

/// Opens what was written.
pub(crate) fn opened(writer: RecordingWriter<Cursor<Vec<u8>>>) -> Recording {
    let bytes = writer.finish().unwrap().into_inner();
    Recording::from_bytes("r.mcap", bytes).unwrap()
}

fn header(scan: usize, frame: &str) -> Header {
    Header::new(Time::from_ns(stamp_ns(scan)).unwrap(), frame)
}

fn mount() -> Message {
    Message::StaticTransforms(TfMessage {
        transforms: vec![TransformStamped {
            header: header(0, "base_link"),
            child_frame_id: "laser".to_owned(),
            transform: Transform {
                translation: Vector3 {
                    x: MOUNT.x,
                    y: MOUNT.y,
                    z: 0.3,
                },
                rotation: ros::Quaternion::from_yaw(MOUNT.yaw),
            },
        }],
    })
}

fn laser_scan(scan: usize) -> Message {
    Message::Scan(LaserScan {
        header: header(scan, "laser"),
        angle_min: -1.5,
        angle_max: 1.5,
        angle_increment: 0.1,
        time_increment: 0.001,
        scan_time: 0.1,
        range_min: 0.05,
        range_max: 80.0,
        ranges: (0..31).map(|beam| (beam + scan) as f32).collect(),
        intensities: vec![f32::INFINITY, 0.5],
    })
}

fn odometry(scan: usize) -> Message {
    let mut message = Odometry {
        header: header(scan, "odom"),
        child_frame_id: "base_link".to_owned(),
        ..Odometry::default()
    };
    message.pose.pose = ros::Pose::from_planar(truth(scan));
    message.pose.covariance[5][5] = 0.01;
    message.twist.twist.angular.z = 0.5;
    message.twist.covariance[0][1] = 0.02;
    Message::Odometry(Box::new(message))
}

fn true_pose(scan: usize) -> Message {
    Message::PoseStamped(PoseStamped {
        header: header(scan, "map"),
        pose: ros::Pose::from_planar(truth(scan)),
    })
}
