//! Poses in the plane as ROS says them.

use geometry::{Pose, wrap_angle};

use crate as ros;
use crate::Quaternion;

/// Steps of a yaw to the radian: 2⁴⁰, so a step is a millionth of a micrometre
/// at a metre.
const STEPS: f64 = (1u64 << 40) as f64;

/// The yaw of which a quaternion is made. A quaternion gives back its yaw with
/// an error of about 1e-15, so the yaw that is read from it is rounded to the
/// same step, and becomes the same quaternion again: a pose that is recorded,
/// played and recorded again does not change by a bit.
fn rounded(yaw: f64) -> f64 {
    let step = (wrap_angle(yaw) * STEPS).round();
    // The half turn itself lies between two steps; beyond it the sign changes.
    let most = (std::f64::consts::PI * STEPS).floor();
    step.clamp(-most, most) / STEPS
}

/// A pose, at height 0.
#[must_use]
pub fn pose(pose: Pose) -> ros::Pose {
    ros::Pose::from_planar(Pose::new(pose.x, pose.y, rounded(pose.yaw)))
}

/// A pose as whoever reads the recording gets it: the same as given, or its yaw
/// off by less than a step.
#[must_use]
pub fn as_recorded(of: Pose) -> Pose {
    pose(of).planar().unwrap_or(of)
}

/// An estimate with its covariance over x, y and yaw.
#[must_use]
pub fn estimate(of: Pose, covariance: [f64; 9]) -> ros::PoseWithCovariance {
    ros::PoseWithCovariance {
        pose: pose(of),
        ..ros::PoseWithCovariance::from_planar(of, covariance)
    }
}

/// A transform, at height 0.
#[must_use]
pub fn transform(pose: Pose) -> ros::Transform {
    ros::Transform::from_planar(Pose::new(pose.x, pose.y, rounded(pose.yaw)))
}

/// The transform of a laser that hangs upside down, where `level` is that of its frame
/// seen from above: it is rolled by half a turn about its x axis.
#[must_use]
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
