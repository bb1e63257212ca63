//! Initial pose from an operator or another program.

use crate::{Pose2, Stamp};

crate::message! {
    #[type_name("InitialPose/v2")]
    /// The message of topic `initial_pose`.
    pub struct InitialPose {
        /// Time of the message.
        pub stamp: Stamp,
        /// Kind of the message, an [`InitialPoseKind`].
        pub kind: u64,
        /// Pose of the robot's base in the map; the laser's if the mount is unknown. Ignored for
        /// [`InitialPoseKind::Anywhere`].
        pub map_from_base: Pose2,
        /// Covariance of that pose, row by row over x, y and yaw: m², m·rad, rad².
        pub covariance: [f64; 9],
    }
}

crate::codes! {
    /// Kind of an initial pose.
    pub enum InitialPoseKind: u64 {
        /// The robot is probably at the pose: it is tried first, and scans must confirm it.
        Hint = 0,
        /// The robot is at the pose: it is believed at once, until scans contradict it.
        Believed = 1,
        /// The robot may be anywhere: the tracker forgets its pose.
        Anywhere = 2,
    }
}
