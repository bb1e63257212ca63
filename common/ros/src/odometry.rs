//! `nav_msgs/msg/Odometry`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, PoseWithCovariance, RosMessage, TwistWithCovariance};

/// What the wheels report.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Odometry {
    /// When, and the frame of the pose.
    pub header: Header,
    /// The frame that moves, and of the twist.
    pub child_frame_id: String,
    /// Where the child frame is.
    pub pose: PoseWithCovariance,
    /// How it moves.
    pub twist: TwistWithCovariance,
}

impl RosMessage for Odometry {
    const SCHEMA: &'static str = "nav_msgs/msg/Odometry";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
",
        Header,
        PoseWithCovariance,
        "\
geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
",
        "\
geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
",
        Vector3,
    );
}
