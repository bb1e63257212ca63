//! ROS 2 messages for recordings and robots: one file for each type, their bytes (`cdr`), and
//! conversions from and to messages of the graph. No I/O.
//!
//! A struct has the fields of its `.msg` in the same order, because CDR does not name fields. Next
//! to it are the definition as a constant, in the form that recordings store, and the conversion
//! from the message of the graph (`of`). Conversions to the plane reject values that are not finite
//! and quaternions that are no rotation.
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

pub mod backcast_msgs;
mod bond;
pub mod cdr;
mod clock;
pub mod cloud;
mod cloud_mount;
mod definition;
mod diagnostic_array;
pub mod diagnostics;
mod error;
mod geometry_msgs;
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
mod pose_array;
mod pose_stamped;
mod pose_with_covariance_stamped;
pub mod poses;
pub mod rcl_interfaces;
mod service;
mod std_msgs;
mod sweep;
mod tf_message;
pub mod type_description_interfaces;

pub use bond::BondStatus;
pub use clock::Clock;
pub use cloud::{Cloud, CloudOptions, Heights};
pub use cloud_mount::CloudMount;
pub use diagnostic_array::{DiagnosticArray, DiagnosticStatus, KeyValue};
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
pub use pose_array::PoseArray;
pub use pose_stamped::PoseStamped;
pub use pose_with_covariance_stamped::PoseWithCovarianceStamped;
pub use service::{Empty, Nothing, RosService};
pub use std_msgs::{Header, Text, Time};
pub use tf_message::{TfMessage, TransformStamped};

/// A message type with its name and definition in recordings.
pub trait RosMessage: serde::Serialize {
    /// Name of the schema.
    const SCHEMA: &'static str;
    /// Text of the schema (`ros2msg`): its fields, then those of each type used.
    const DEFINITION: &'static str;
}

#[cfg(test)]
mod tests {
    use super::backcast_msgs::{Beams, Hypotheses, Localization, Votes};
    use super::*;

    /// Definitions that use the same type contain the same text for it.
    #[test]
    fn definitions_agree_on_the_types_that_they_share() {
        let definitions = [
            LaserScan::DEFINITION,
            PointCloud2::DEFINITION,
            OccupancyGridMsg::DEFINITION,
            Odometry::DEFINITION,
            PoseStamped::DEFINITION,
            TfMessage::DEFINITION,
            PoseWithCovarianceStamped::DEFINITION,
            PoseArray::DEFINITION,
            DiagnosticArray::DEFINITION,
            Log::DEFINITION,
            BondStatus::DEFINITION,
            nav2_msgs::ParticleCloud::DEFINITION,
            lifecycle_msgs::TransitionEvent::DEFINITION,
            Votes::DEFINITION,
            Hypotheses::DEFINITION,
            Beams::DEFINITION,
            Localization::DEFINITION,
            Clock::DEFINITION,
            rcl_interfaces::ParameterEvent::DEFINITION,
        ];
        let mut known = std::collections::BTreeMap::new();
        for definition in definitions {
            let parts: Vec<&str> = definition.split(&"=".repeat(80)).collect();
            assert!(parts.len() > 1, "{definition}");
            for part in &parts[1..] {
                let (name, fields) = part.trim_start().split_once('\n').unwrap();
                assert!(name.starts_with("MSG: "), "{name}");
                let other = known.entry(name).or_insert(fields.trim_end());
                assert_eq!(*other, fields.trim_end(), "{name}");
            }
        }
    }
}
