//! Conversion of initial poses to the graph's message. Pure.
//!
//! Rejects poses in other frames than the map's, and invalid covariances.

use geometry::{Covariance, Pose};
use messages::{InitialPose, InitialPoseKind, Pose2, Stamp};
use ros::PoseWithCovarianceStamped;

use crate::GatewayError;
use crate::checks::measured_ns;

/// Standard deviations of a pose without a covariance, metres and radians; those of RViz.
const UNSAID: (f64, f64) = (0.5, 0.26);

/// Smallest standard deviations, metres and radians: no user points more precisely.
const LEAST: (f64, f64) = (0.1, 0.05);

/// Converts the pose of a message, moved on by the robot's motion since its stamp.
pub(super) fn of_message(
    kind: InitialPoseKind,
    message: &PoseWithCovarianceStamped,
    map_frame: &str,
    moved_since: impl FnOnce(i64) -> Option<Pose>,
) -> Result<InitialPose, GatewayError> {
    let frame = message.header.frame_id.trim_start_matches('/');
    if frame != map_frame.trim_start_matches('/') {
        return Err(GatewayError::Refused(format!(
            "the initial pose is in frame {:?}: allowed is {map_frame:?}",
            message.header.frame_id
        )));
    }
    let said_ns = measured_ns("the initial pose", message.header.stamp)?;
    let pose = message.pose.pose.planar()?;
    let moved = moved_since(said_ns).unwrap_or_default();
    let now = pose.then(moved);
    let covariance = widened(message.pose.planar_covariance())?;
    Ok(InitialPose {
        stamp: Stamp {
            measured_ns: said_ns,
            ..Stamp::default()
        },
        kind: kind as u64,
        map_from_base: now.into(),
        covariance: covariance
            .carried(pose, Pose::new(now.x, now.y, pose.yaw))
            .to_rows(),
    })
}

/// Converts a pose of the parameters or of the saved file.
pub(super) fn of_parameters(kind: InitialPoseKind, pose: Pose) -> InitialPose {
    InitialPose {
        stamp: Stamp::default(),
        kind: kind as u64,
        map_from_base: pose.into(),
        covariance: unsaid().to_rows(),
    }
}

pub(super) fn anywhere() -> InitialPose {
    InitialPose {
        stamp: Stamp::default(),
        kind: InitialPoseKind::Anywhere as u64,
        map_from_base: Pose2::from(Pose::IDENTITY),
        covariance: [0.0; 9],
    }
}

fn unsaid() -> Covariance {
    let (metres, radians) = UNSAID;
    Covariance::from_deviations(metres, metres, radians)
}

fn widened(rows: [f64; 9]) -> Result<Covariance, GatewayError> {
    if rows == [0.0; 9] {
        return Ok(unsaid());
    }
    let (mut wide, (metres, radians)) = (rows, LEAST);
    for (variance, least) in [(0, metres), (4, metres), (8, radians)] {
        wide[variance] = wide[variance].max(least * least);
    }
    let covariance = Covariance::from_rows(wide);
    let is_sound = rows.iter().all(|value| value.is_finite())
        && [rows[0], rows[4], rows[8]]
            .iter()
            .all(|variance| *variance >= 0.0)
        && covariance.is_positive_definite();
    is_sound.then_some(covariance).ok_or_else(|| {
        GatewayError::Refused(
            "the covariance of the initial pose is none: allowed are finite, symmetric and positive \
             ones, and zeros for what is unknown"
                .to_owned(),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(frame: &str) -> PoseWithCovarianceStamped {
        let mut message = PoseWithCovarianceStamped::default();
        message.header.frame_id = frame.to_owned();
        message.pose.pose.position.x = 2.0;
        message.pose.pose.orientation = ros::Quaternion::from_yaw(std::f64::consts::FRAC_PI_2);
        message
    }

    fn hint(message: &PoseWithCovarianceStamped) -> Result<InitialPose, GatewayError> {
        of_message(InitialPoseKind::Hint, message, "map", |_| None)
    }

    #[test]
    fn a_pose_is_carried_on_by_what_the_robot_moved() {
        let mut message = said("/map");
        message.header.stamp.sec = 7;
        let moved = |ns| (ns == 7_000_000_000).then(|| Pose::new(1.0, 0.0, 0.5));
        let hint = of_message(InitialPoseKind::Hint, &message, "map", moved).unwrap();
        let expected = Pose::new(2.0, 1.0, std::f64::consts::FRAC_PI_2 + 0.5);
        assert!(Pose::from(hint.map_from_base).is_within(expected, 1e-12, 1e-12));
        // The message has no covariance.
        assert_eq!(hint.covariance[8], 0.26 * 0.26);
    }

    #[test]
    fn another_frame_is_refused_by_name() {
        for frame in ["odom", "", "map2"] {
            let error = hint(&said(frame)).unwrap_err().to_string();
            assert!(
                error.contains(&format!("{frame:?}")) && error.contains("\"map\""),
                "{error}"
            );
        }
    }

    #[test]
    fn a_covariance_is_one_and_never_too_tight() {
        let mut message = said("map");
        message.pose.covariance[0][0] = 1e-9;
        message.pose.covariance[5][5] = 0.5;
        let found = hint(&message).unwrap().covariance;
        assert_eq!([found[0], found[8]], [0.1 * 0.1, 0.5]);
        for wrong in [f64::NAN, -1.0, f64::INFINITY] {
            message.pose.covariance[1][1] = wrong;
            let error = hint(&message).unwrap_err().to_string();
            assert!(error.contains("covariance"), "{error}");
        }
        message.pose.covariance[1][1] = 1.0;
        message.pose.covariance[0][1] = 5.0;
        message.pose.covariance[1][0] = 5.0;
        assert!(hint(&message).is_err());
    }
}
