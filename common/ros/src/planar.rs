//! Converts poses in the plane to messages of ROS.

use geometry::{Pose, wrap_angle};

use crate as ros;
use crate::Quaternion;

/// Resolution of a yaw, in steps per radian: a step of 2⁻⁴⁰ rad moves a point at a distance of one
/// metre by a millionth of a micrometre.
const STEPS: f64 = (1u64 << 40) as f64;

/// Rounds a yaw before it is converted to a quaternion. A quaternion returns its yaw with an error
/// of about 1e-15, so a yaw that is read from it rounds to the same step and gives the same
/// quaternion: a pose that is recorded, replayed and recorded again stays the same in every bit.
fn rounded(yaw: f64) -> f64 {
    let step = (wrap_angle(yaw) * STEPS).round();
    // π itself is between two steps; beyond it the sign would change.
    let most = (std::f64::consts::PI * STEPS).floor();
    step.clamp(-most, most) / STEPS
}

/// Converts a pose, at height 0.
pub fn pose(pose: Pose) -> ros::Pose {
    ros::Pose::from_planar(Pose::new(pose.x, pose.y, rounded(pose.yaw)))
}

/// Pose that a reader of the recording gets: the given one, with its yaw off by less than a step.
pub fn as_recorded(of: Pose) -> Pose {
    pose(of).planar().unwrap_or(of)
}

/// Converts an estimate with its covariance over x, y and yaw.
pub fn estimate(of: Pose, covariance: [f64; 9]) -> ros::PoseWithCovariance {
    ros::PoseWithCovariance {
        pose: pose(of),
        ..ros::PoseWithCovariance::from_planar(of, covariance)
    }
}

/// Converts a transform, at height 0.
pub fn transform(pose: Pose) -> ros::Transform {
    ros::Transform::from_planar(Pose::new(pose.x, pose.y, rounded(pose.yaw)))
}

/// Transform of a laser that is mounted upside down: `level`, its frame seen from above, rolled by
/// half a turn about its x axis.
pub fn upside_down(level: ros::Transform) -> ros::Transform {
    let turn = level.rotation;
    ros::Transform {
        rotation: Quaternion {
            x: turn.w,
            y: turn.z,
            z: 0.0,
            w: 0.0,
        },
        ..level
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;

    fn assert_same_again(yaw: f64) {
        let first = pose(Pose::new(1.0, 2.0, yaw));
        let read = first.planar().unwrap();
        assert_eq!(pose(read), first, "{yaw}");
        assert_eq!(as_recorded(read), read, "{yaw}");
        assert!((read.yaw - wrap_angle(yaw)).abs() < 1e-12, "{yaw}");
    }

    #[test]
    fn half_turns_keep_their_sign() {
        for yaw in [PI, -PI + 1e-9, PI - 1e-13, 0.0, -0.5 * PI] {
            assert_same_again(yaw);
        }
    }

    proptest! {
        #[test]
        fn a_pose_that_is_read_and_written_again_is_the_same(yaw in -3.1..3.1f64) {
            assert_same_again(yaw);
        }
    }
}
