//! Messages of recordings that are made here, with the usual frames of robots.

use geometry::Pose;
use recording::Message;
use ros::{Header, PoseStamped, TfMessage, Time, Transform, TransformStamped, Twist};

/// Odometry of `base_link` in `odom`; the twist is in the frame of the base.
pub(crate) fn odometry(stamp: Time, odom_from_base: Pose, twist: Pose) -> Message {
    let mut message = ros::Odometry {
        header: Header::new(stamp, "odom"),
        child_frame_id: "base_link".to_owned(),
        ..ros::Odometry::default()
    };
    message.pose.pose = ros::Pose::from_planar(odom_from_base);
    message.twist.twist = Twist::from_planar(twist);
    Message::Odometry(Box::new(message))
}

/// True pose of the laser.
pub(crate) fn truth(stamp: Time, map_from_laser: Pose) -> Message {
    Message::PoseStamped(PoseStamped {
        header: Header::new(stamp, "map"),
        pose: ros::Pose::from_planar(map_from_laser),
    })
}

/// Mounts of lasers on `base_link`, by their frames.
pub(crate) fn mounts(stamp: Time, lasers: impl Iterator<Item = (String, Transform)>) -> Message {
    let transforms = lasers.map(|(child_frame_id, transform)| TransformStamped {
        header: Header::new(stamp, "base_link"),
        child_frame_id,
        transform,
    });
    Message::StaticTransforms(TfMessage {
        transforms: transforms.collect(),
    })
}
