//! `geometry_msgs/msg/PoseArray`.

use serde::{Deserialize, Serialize};

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
    const DEFINITION: &'static str = "\
std_msgs/Header header
geometry_msgs/Pose[] poses
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
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
