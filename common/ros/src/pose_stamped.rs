//! `geometry_msgs/msg/PoseStamped`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, Pose, RosMessage};

/// A pose, when it was, and in which frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PoseStamped {
    /// When, and the frame of the pose.
    pub header: Header,
    /// The pose.
    pub pose: Pose,
}

impl RosMessage for PoseStamped {
    const SCHEMA: &'static str = "geometry_msgs/msg/PoseStamped";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
geometry_msgs/Pose pose
",
        Header,
        Pose,
    );
}
