//! ROS 2 messages for recordings and robots, their bytes (`cdr`), and conversions from and to
//! messages of the graph. No I/O.
//!
//! A struct has the fields of its `.msg` in the same order, because CDR does not name fields.
//! `definition` makes the text that recordings store of the same declaration. Next to it is the
//! conversion from the message of the graph (`of`). Conversions to the plane reject values that are
//! not finite and quaternions that are no rotation.
//!
//! | file | conversion between graph and ROS |
//! |---|---|
//! | `measurements` | scans, odometry and true poses, to the graph |
//! | `poses`, `planar` | poses and transforms, to ROS |
//! | `diagnostics` | health, to ROS |
//! | `lasers` | names of lasers and topics, both ways |
//! | `cloud` | point clouds, to scans of a laser |
//!
//! The types are written by hand although `hiroz-msgs` generates those of ROS: it depends on
//! `hiroz`, and with it on all of Zenoh, which takes longer to build than everything that reads or
//! writes a recording.

#[macro_use]
mod definition;
#[macro_use]
mod std_msgs;
#[macro_use]
mod geometry_msgs;
#[macro_use]
mod stamped;

pub mod backcast_msgs;
pub mod cdr;
pub mod cloud;
mod cloud_mount;
pub mod diagnostics;
mod error;
mod laser_scan;
pub mod lasers;
pub mod lifecycle_msgs;
mod livox;
mod log;
pub mod measurements;
pub mod nav2_msgs;
mod occupancy_grid;
mod odometry;
pub mod planar;
mod point_cloud;
pub mod poses;
pub mod rcl_interfaces;
mod service;
mod sweep;
pub mod type_description_interfaces;

pub use cloud::{Cloud, CloudOptions, Heights};
pub use cloud_mount::CloudMount;
pub use diagnostics::{DiagnosticArray, DiagnosticStatus, KeyValue};
pub use error::ConversionError;
pub use geometry_msgs::{
    Mend, Point, Pose, PoseWithCovariance, Quaternion, Transform, Twist, TwistWithCovariance,
    Vector3,
};
pub use laser_scan::LaserScan;
pub use livox::{CustomMsg, CustomPoint};
pub use log::Log;
pub use occupancy_grid::{MapMetaData, OccupancyGridMsg};
pub use odometry::Odometry;
pub use point_cloud::{CloudPoint, PointCloud2, PointField};
pub use service::{Empty, Nothing, RosService};
pub use stamped::{PoseArray, PoseStamped, PoseWithCovarianceStamped, TfMessage, TransformStamped};
pub use std_msgs::{BondStatus, Clock, Header, Text, Time};

/// A message type with its name and definition in recordings.
pub trait RosMessage: serde::Serialize {
    /// Name of the schema.
    const SCHEMA: &'static str;
    /// Text of the schema (`ros2msg`): its fields, then those of each type used.
    const DEFINITION: &'static str;
}
