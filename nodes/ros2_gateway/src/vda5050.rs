//! Position of the robot in the format of VDA 5050, for a fleet's master control. Pure.

use geometry::{Covariance, Pose};
use messages::PoseHeader;
use serde::Serialize;

/// Radius, in standard deviations, that holds 95 % of a normal distribution in the plane.
const WITHIN_95: f64 = 2.447_746_830_680_816;

/// `mobileRobotPosition` of VDA 5050 3.0, `agvPosition` of 2.x, with the field names of the
/// standard.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Position {
    /// Position of the robot's base in the map, metres; `None` if it is not localized.
    x: Option<f64>,
    y: Option<f64>,
    /// Heading, radians, counter-clockwise.
    theta: Option<f64>,
    /// Map id, 16 hexadecimal digits.
    #[serde(rename = "mapId")]
    map_id: String,
    /// True if the tracker believes a pose of the robot.
    localized: bool,
    /// Probability of the pose, 0..=1; 0 if the robot is not localized.
    #[serde(rename = "localizationScore")]
    localization_score: f64,
    /// Radius around x and y that holds the robot with 95 % probability, metres.
    #[serde(rename = "deviationRange")]
    deviation_range: Option<f64>,
}

pub(crate) fn of(from: &PoseHeader) -> Position {
    // The pose of a laser is not the robot's.
    let localized = from.is_believed() && from.mount_known == 1;
    let base = localized.then(|| Pose::from(from.map_from_base));
    let ellipse = Covariance::from_rows(from.base_covariance).ellipse();
    Position {
        x: base.map(|base| base.x),
        y: base.map(|base| base.y),
        theta: base.map(|base| base.yaw),
        map_id: ros::backcast_msgs::map_id(from),
        localized,
        localization_score: if localized { from.probability } else { 0.0 },
        deviation_range: localized.then_some(WITHIN_95 * ellipse.major_m),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::TrackState;
    use serde_json::json;

    use super::*;

    #[test]
    fn what_is_believed_has_the_names_of_the_standard() {
        let mut from = PoseHeader {
            map_id: 0xff,
            state: TrackState::Unique as u32,
            pose_known: 1,
            mount_known: 1,
            probability: 0.75,
            map_from_base: Pose::new(1.0, -2.0, 0.5).into(),
            base_covariance: Covariance::from_deviations(0.1, 0.2, 0.01).to_rows(),
            ..PoseHeader::zeroed()
        };
        let mut found = serde_json::to_value(of(&from)).unwrap();
        // The square root of -2 ln 0.05, of the longer axis.
        let range = found["deviationRange"].take().as_f64().unwrap();
        assert!(
            (range - 0.2 * (-2.0 * 0.05f64.ln()).sqrt()).abs() < 1e-9,
            "{range}"
        );
        let expected = json!({
            "x": 1.0, "y": -2.0, "theta": 0.5, "mapId": "00000000000000ff", "localized": true,
            "localizationScore": 0.75, "deviationRange": null,
        });
        assert_eq!(found, expected);
        from.state = TrackState::Lost as u32;
        let found = serde_json::to_value(of(&from)).unwrap();
        let expected = json!({
            "x": null, "y": null, "theta": null, "mapId": "00000000000000ff",
            "localized": false, "localizationScore": 0.0, "deviationRange": null,
        });
        assert_eq!(found, expected);
    }

    #[test]
    fn a_laser_whose_mount_is_not_known_localizes_no_robot() {
        let from = PoseHeader {
            state: TrackState::Unique as u32,
            pose_known: 1,
            ..PoseHeader::zeroed()
        };
        assert!(!of(&from).localized);
    }
}
