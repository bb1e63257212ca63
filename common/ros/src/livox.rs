//! `CustomMsg` of Livox' drivers, `livox_ros_driver2` and `livox_ros_driver`, which have the same
//! fields (<https://github.com/Livox-SDK/livox_ros_driver2>, `msg/`).

use serde::{Deserialize, Serialize};

use super::{CloudPoint, Header};

/// A cloud of points of a Livox lidar.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CustomMsg {
    pub header: Header,
    /// Time of the first point on the clock of the lidar, in nanoseconds.
    pub timebase: u64,
    pub point_num: u32,
    pub lidar_id: u8,
    pub rsvd: [u8; 3],
    pub points: Vec<CustomPoint>,
}

/// A point of a Livox lidar.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CustomPoint {
    /// Time since the first point, in nanoseconds.
    pub offset_time: u32,
    /// Place in the frame of the lidar, in metres; all zero without a return.
    pub x: f32,
    pub y: f32,
    pub z: f32,
    pub reflectivity: u8,
    pub tag: u8,
    pub line: u8,
}

/// Names of the message's schema.
pub(crate) const SCHEMAS: [&str; 2] = [
    "livox_ros_driver2/msg/CustomMsg",
    "livox_ros_driver/msg/CustomMsg",
];

impl CustomMsg {
    /// Iterates over all points; the stamp of the message is that of the first one.
    pub fn points(&self) -> impl Iterator<Item = CloudPoint> {
        self.points.iter().map(|point| CloudPoint {
            place: [point.x, point.y, point.z].map(f64::from),
            time_s: f64::from(point.offset_time) * 1e-9,
        })
    }
}
