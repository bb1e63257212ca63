//! Wheel odometry.

use crate::{FrameName, Pose2, Stamp};

crate::message! {
    #[type_name("Odometry/v2")]
    /// The message of topic `odometry`.
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
}
