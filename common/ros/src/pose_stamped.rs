//! `geometry_msgs/msg/PoseStamped`.

use messages::GroundTruth;
use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, Pose, RosMessage, Time, planar};

/// A pose with its time and frame.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PoseStamped {
    /// Time, and the frame of the pose.
    pub header: Header,
    pub pose: Pose,
}

impl PoseStamped {
    /// Converts a true pose of the graph; `stamp` is the time of the header.
    #[must_use]
    pub fn of(stamp: Time, truth: &GroundTruth) -> Self {
        PoseStamped {
            header: Header::new(stamp, truth.frame.as_str()),
            pose: planar::pose(truth.map_from_laser.into()),
        }
    }
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
