//! Messages for data that no message of ROS holds without loss: the graph's `votes`, `hypotheses`,
//! `beams` and `pose` with every field of their headers, and the tracker's verdict in the form that
//! a robot's programs need. A field has the meaning of the one of that name in `messages`; `header`
//! has the time of the scan and the frame of the map.
//!
//! They are plain `ros2msg` and CDR, so any generic reader decodes them. Numbers that stand for a
//! state are the same as in the graph, and the definition names them as constants. Sequences are
//! the last fields, since readers differ in how they align fields after an empty one. A message
//! with an additional field is a new message with a new name.

declare! {
    /// `geometry_msgs/msg/Pose2D` of ROS 2.
    #[derive(Copy)]
    part Pose2D = "geometry_msgs/Pose2D" [] {
        /// Metres.
        x: f64,
        y: f64,
        /// Heading, in radians counter-clockwise.
        theta: f64,
    }
}

impl From<messages::Pose2> for Pose2D {
    fn from(messages::Pose2 { x, y, yaw: theta }: messages::Pose2) -> Self {
        Pose2D { x, y, theta }
    }
}

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
