//! `geometry_msgs/msg/PoseArray`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, Pose, RosMessage};

/// Poses at one time, in one frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PoseArray {
    /// Time, and the frame of the poses.
    pub header: Header,
    /// Poses, in the order of the writer.
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
