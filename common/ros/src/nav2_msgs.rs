//! Types of `nav2_msgs` that a localizer uses.

use serde::{Deserialize, Serialize};

use super::definition::definition;
use super::service::{Nothing, service};
use super::{Header, Pose, PoseWithCovarianceStamped, RosMessage};

/// `nav2_msgs/msg/ParticleCloud`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ParticleCloud {
    /// Time, and the frame of the poses.
    pub header: Header,
    /// Possible poses of the robot.
    pub particles: Vec<Particle>,
}

/// `nav2_msgs/msg/Particle`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Particle {
    pub pose: Pose,
    /// Probability of the pose; the sum over all particles is at most 1.
    pub weight: f64,
}

impl RosMessage for ParticleCloud {
    const SCHEMA: &'static str = "nav2_msgs/msg/ParticleCloud";
    const DEFINITION: &'static str = definition!(
        "\
std_msgs/Header header
nav2_msgs/Particle[] particles
",
        Header,
        "\
nav2_msgs/Particle
geometry_msgs/Pose pose
float64 weight
",
        Pose,
    );
}

/// Pose of the robot, as on topic `initialpose`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SetInitialPoseRequest {
    pub pose: PoseWithCovarianceStamped,
}

service!(
    SetInitialPose,
    "nav2_msgs/srv/SetInitialPose",
    SetInitialPoseRequest: definition!(
        "geometry_msgs/PoseWithCovarianceStamped pose\n",
        "\
geometry_msgs/PoseWithCovarianceStamped
std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
",
        Header,
        PoseWithCovariance,
    ),
    Nothing: "",
);
