//! `geometry_msgs/msg/PoseWithCovarianceStamped`.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::{Header, PoseWithCovariance, RosMessage};

/// A pose with its covariance.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PoseWithCovarianceStamped {
    /// Time, and the frame of the pose.
    pub header: Header,
    pub pose: PoseWithCovariance,
}

impl RosMessage for PoseWithCovarianceStamped {
    const SCHEMA: &'static str = "geometry_msgs/msg/PoseWithCovarianceStamped";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
",
        Header,
        PoseWithCovariance,
    );
}
