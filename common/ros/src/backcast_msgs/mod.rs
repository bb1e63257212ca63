//! Messages of our own, for what no message of ROS holds without loss: the
//! graph's `votes`, `hypotheses`, `beams` and `pose` with every field of their headers, and
//! the verdict as a robot's programs need it.
//!
//! They are plain `ros2msg` and CDR, so a generic reader decodes them. Numbers
//! that name a state stand as in the graph, with their names as constants in
//! the definition; sequences stand last, since readers differ in how they align
//! what follows an empty one. A field that is added makes another message, under
//! another name.

mod beams;
mod hypotheses;
mod localization;
mod tracked_pose;
mod votes;

pub use beams::{Beam, Beams};
pub use hypotheses::{Hypotheses, Hypothesis};
pub use localization::{Localization, map_id};
pub use tracked_pose::TrackedPose;
pub use votes::{Vote, Votes};

use serde::{Deserialize, Serialize};

/// `geometry_msgs/msg/Pose2D` as ROS 2 has had it: metres and radians.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2D {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Radians, counter-clockwise.
    pub theta: f64,
}

impl From<geometry::Pose> for Pose2D {
    fn from(pose: geometry::Pose) -> Self {
        Pose2D {
            x: pose.x,
            y: pose.y,
            theta: pose.yaw,
        }
    }
}

impl From<messages::Pose2> for Pose2D {
    fn from(pose: messages::Pose2) -> Self {
        geometry::Pose::from(pose).into()
    }
}

impl From<Pose2D> for geometry::Pose {
    fn from(pose: Pose2D) -> Self {
        geometry::Pose::new(pose.x, pose.y, pose.theta)
    }
}
