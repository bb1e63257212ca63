//! The ROS 2 messages that recordings are read for, one file each.
//!
//! A struct has the fields of its `.msg` in their order, because CDR names
//! none: the definition stands beside it as a constant, in the form in which a
//! recording carries it. Conversions to the plane refuse what is no number or
//! no rotation.

mod conversion;
mod geometry_msgs;
mod laser_scan;
mod occupancy_grid;
mod odometry;
mod pose_stamped;
mod std_msgs;
mod tf_message;

pub use conversion::ConversionError;
pub use geometry_msgs::{
    Point, Pose, PoseWithCovariance, Quaternion, Transform, Twist, TwistWithCovariance, Vector3,
};
pub use laser_scan::LaserScan;
pub use occupancy_grid::{MapMetaData, OccupancyGridMsg};
pub use odometry::Odometry;
pub use pose_stamped::PoseStamped;
pub use std_msgs::{Header, Time};
pub use tf_message::{TfMessage, TransformStamped};

/// A message type, as recordings name and define it.
pub trait RosMessage {
    /// The schema's name.
    const SCHEMA: &'static str;
    /// The schema's text (`ros2msg`): the fields, then those of each type used.
    const DEFINITION: &'static str;
}
