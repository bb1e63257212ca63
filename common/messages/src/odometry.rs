//! Wheel odometry.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{FrameName, Pose2, Stamp};

/// The message of topic `odometry`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Odometry/v2"))]
#[repr(C)]
pub struct Odometry {
    /// Stamp of the measurement.
    pub stamp: Stamp,
    /// Pose of `child_frame` relative to the start of the odometry.
    pub odom_from_child: Pose2,
    /// Velocity in the child frame: m/s, m/s, rad/s.
    pub twist: Pose2,
    /// Covariance of the pose, row by row over x, y and yaw: m², m·rad, rad².
    pub covariance: [f64; 9],
    /// Frame of the pose.
    pub frame: FrameName,
    /// Frame that moves: the robot's base or the laser.
    pub child_frame: FrameName,
}
