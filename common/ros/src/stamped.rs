//! Poses and transforms with their time and frame.

use messages::GroundTruth;

use super::{Header, Pose, PoseWithCovariance, Time, Transform, planar};

declare! {
    /// A pose with its covariance.
    message PoseWithCovarianceStamped = "geometry_msgs/msg/PoseWithCovarianceStamped"
        [Header, PoseWithCovariance] {
        /// Time, and the frame of the pose.
        header: Header,
        pose: PoseWithCovariance,
    }

    part TransformStamped = "geometry_msgs/TransformStamped" [Header, Transform] {
        /// Time, and the parent frame.
        header: Header,
        child_frame_id: String,
        /// Pose of the child frame in the parent frame.
        transform: Transform,
    }

    /// `tf2_msgs/msg/TFMessage`: transforms between frames, in any order.
    message TfMessage = "tf2_msgs/msg/TFMessage" [TransformStamped] {
        transforms: Vec<TransformStamped>,
    }

    /// `geometry_msgs/msg/PoseArray`: poses at one time, in one frame.
    message PoseArray = "geometry_msgs/msg/PoseArray" [Header, Pose] {
        /// Time, and the frame of the poses.
        header: Header,
        /// Poses, in the order of the writer.
        poses: Vec<Pose>,
    }

    /// `geometry_msgs/msg/PoseStamped`: a pose with its time and frame.
    message PoseStamped = "geometry_msgs/msg/PoseStamped" [Header, Pose] {
        /// Time, and the frame of the pose.
        header: Header,
        pose: Pose,
    }
}

impl PoseStamped {
    /// Converts a true pose of the graph; `stamp` is the time of the header.
    pub fn of(stamp: Time, truth: &GroundTruth) -> Self {
        PoseStamped {
            header: Header::new(stamp, truth.frame.as_str()),
            pose: planar::pose(truth.map_from_laser.into()),
        }
    }
}
