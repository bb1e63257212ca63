//! `nav_msgs/msg/Odometry`.

use super::{Header, PoseWithCovariance, Time, Twist, TwistWithCovariance, planar};

declare! {
    /// Pose and velocity from wheel odometry.
    message Odometry = "nav_msgs/msg/Odometry" [Header, PoseWithCovariance, TwistWithCovariance] {
        /// Time, and the frame of the pose.
        header: Header,
        /// Moving frame, in which the twist is given.
        child_frame_id: String,
        /// Pose of the child frame.
        pose: PoseWithCovariance,
        /// Velocity in the child frame.
        twist: TwistWithCovariance,
    }
}

impl Odometry {
    /// Converts odometry of the graph; `stamp` is the time of the header.
    pub fn of(stamp: Time, odometry: &messages::Odometry) -> Self {
        Odometry {
            header: Header::new(stamp, odometry.frame.as_str()),
            child_frame_id: odometry.child_frame.as_str().to_owned(),
            pose: planar::estimate(odometry.odom_from_child.into(), odometry.covariance),
            twist: TwistWithCovariance {
                twist: Twist::from_planar(odometry.twist.into()),
                ..TwistWithCovariance::default()
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, Pose2};

    use super::*;

    #[test]
    fn odometry_comes_back() {
        let pose = Pose2::from(geometry::Pose::new(1.0, 2.0, 0.5));
        let given = messages::Odometry {
            odom_from_child: pose,
            twist: pose,
            covariance: [0.25; 9],
            frame: FrameName::new("odom"),
            child_frame: FrameName::new("base_link"),
            ..messages::Odometry::zeroed()
        };
        let message = Odometry::of(Time::default(), &given);
        assert_eq!(message.child_frame_id, "base_link");
        assert_eq!(message.pose.planar_covariance(), [0.25; 9]);
        assert_eq!(message.twist.twist.planar(), pose.into());
        let back = message.pose.pose.planar().unwrap();
        // The yaw is rounded to multiples of 2⁻⁴⁰ rad.
        assert!(back.is_within(pose.into(), 0.0, 1e-12), "{back:?}");
    }
}
