//! `tf2_msgs/msg/TFMessage`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, RosMessage, Transform};

/// Transforms between frames, in any order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TfMessage {
    pub transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TransformStamped {
    /// Time, and the parent frame.
    pub header: Header,
    pub child_frame_id: String,
    /// Pose of the child frame in the parent frame.
    pub transform: Transform,
}

impl RosMessage for TfMessage {
    const SCHEMA: &'static str = "tf2_msgs/msg/TFMessage";
    const DEFINITION: &'static str = definition!(
        "\
geometry_msgs/TransformStamped[] transforms
",
        "\
geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
",
        Header,
        "\
geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
",
        Vector3,
        Quaternion,
    );
}
