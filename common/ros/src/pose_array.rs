//! `geometry_msgs/msg/PoseArray`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, Pose, RosMessage};

/// Poses of one moment, in one frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PoseArray {
    /// When, and the frame of the poses.
    pub header: Header,
    /// The poses; their order is the writer's choice.
    pub poses: Vec<Pose>,
}

impl RosMessage for PoseArray {
    const SCHEMA: &'static str = "geometry_msgs/msg/PoseArray";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
geometry_msgs/Pose[] poses
",
        Header,
        Pose,
    );
}
