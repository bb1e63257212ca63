//! Messages for data that no message of ROS holds without loss: the graph's `votes`, `hypotheses`,
//! `beams` and `pose` with every field of their headers, and the tracker's verdict in the form that
//! a robot's programs need.
//!
//! They are plain `ros2msg` and CDR, so any generic reader decodes them. Numbers that stand for a
//! state are the same as in the graph, and the definition names them as constants. Sequences are
//! the last fields, since readers differ in how they align fields after an empty one. A message
//! with an additional field is a new message with a new name.

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

/// `geometry_msgs/msg/Pose2D` of ROS 2.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2D {
    /// X, in metres.
    pub x: f64,
    /// Y, in metres.
    pub y: f64,
    /// Heading, in radians counter-clockwise.
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
