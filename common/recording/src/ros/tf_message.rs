//! `tf2_msgs/msg/TFMessage`.

use serde::{Deserialize, Serialize};

use super::{Header, RosMessage, Transform};

/// Transforms between frames.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TfMessage {
    /// In any order.
    pub transforms: Vec<TransformStamped>,
}

/// `geometry_msgs/msg/TransformStamped`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TransformStamped {
    /// When, and the outer frame.
    pub header: Header,
    /// The inner frame.
    pub child_frame_id: String,
    /// Takes coordinates of the inner frame to the outer one.
    pub transform: Transform,
}

impl RosMessage for TfMessage {
    const SCHEMA: &'static str = "tf2_msgs/msg/TFMessage";
    const DEFINITION: &'static str = "\
geometry_msgs/TransformStamped[] transforms
================================================================================
MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
";
}
