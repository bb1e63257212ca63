//! Types of `nav2_msgs` that a localizer uses.

use super::{Header, Nothing, Pose, PoseWithCovarianceStamped};

declare! {
    #[derive(Copy)]
    part Particle = "nav2_msgs/Particle" [Pose] {
        pose: Pose,
        /// Probability of the pose; the sum over all particles is at most 1.
        weight: f64,
    }

    message ParticleCloud = "nav2_msgs/msg/ParticleCloud" [Header, Particle] {
        /// Time, and the frame of the poses.
        header: Header,
        /// Possible poses of the robot.
        particles: Vec<Particle>,
    }

    /// Pose of the robot, as on topic `initialpose`.
    call SetInitialPoseRequest {
        pose: PoseWithCovarianceStamped,
    }

    service SetInitialPose = "nav2_msgs/srv/SetInitialPose": SetInitialPoseRequest -> Nothing;
}
