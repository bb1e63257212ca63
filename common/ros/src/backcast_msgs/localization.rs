//! `backcast_msgs/msg/Localization`.

use messages::PoseHeader;
use serde::{Deserialize, Serialize};

use crate::{Header, PoseWithCovariance, RosMessage, Time, planar};

/// Pose of the robot and its certainty, for programs of a robot: the part of the tracker's verdict
/// on a scan that they base decisions on. The definition says what the fields mean.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Localization {
    pub header: Header,
    pub state: u8,
    pub probability: f64,
    pub since: Time,
    pub alternatives: u32,
    pub map_id: String,
    pub pose_known: bool,
    pub pose: PoseWithCovariance,
    pub reason: String,
}

impl Localization {
    /// Converts the tracker's result for a scan, with its text.
    pub fn of(header: Header, from: &PoseHeader, words: &[u8]) -> Self {
        // Without a mount only the laser's pose is known, which is not the robot's.
        let pose = from
            .base()
            .map(|base| planar::estimate(base.into(), from.base_covariance));
        Localization {
            header,
            // There are four states.
            state: u8::try_from(from.state).unwrap_or(u8::MAX),
            probability: from.probability,
            since: Time::from_ns(from.since_ns.max(0)).unwrap_or_default(),
            alternatives: from.places.saturating_sub(1),
            map_id: map_id(from),
            pose_known: pose.is_some(),
            pose: pose.unwrap_or_default(),
            reason: String::from_utf8_lossy(words).into_owned(),
        }
    }
}

/// Id of the map as 16 hexadecimal digits; empty if there is no map.
pub fn map_id(from: &PoseHeader) -> String {
    match from.map_id {
        0 => String::new(),
        id => format!("{id:016x}"),
    }
}

impl RosMessage for Localization {
    const SCHEMA: &'static str = "backcast_msgs/msg/Localization";
    const DEFINITION: &'static str = concat!(
        "\
# Where the robot is, and how sure that is: the tracker's verdict on a scan.
uint8 SEARCHING=0
uint8 UNIQUE=1
uint8 DOUBTFUL=2
uint8 LOST=3
# When the scan was measured, and the frame of the map.
std_msgs/Header header
# What is known: one of the constants above.
uint8 state
# How likely the robot is at the pose, 0 to 1.
float64 probability
# When the state began.
builtin_interfaces/Time since
# Other places that are possible.
uint32 alternatives
# The map, 16 hexadecimal digits; empty where there is none.
string map_id
# Whether there is a pose.
bool pose_known
# Of the robot's base in the map, metres: where the robot is believed to be while UNIQUE or
# DOUBTFUL, else the place that leads.
geometry_msgs/PoseWithCovariance pose
# Why, and what to do, in words.
string reason
",
        Header!(part),
        PoseWithCovariance!(part),
    );
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::TrackState;

    use super::*;

    #[test]
    fn the_message_says_what_the_tracker_says() {
        let mut from = PoseHeader {
            map_id: 0xff,
            state: TrackState::Doubtful as u32,
            places: 3,
            since_ns: 5_000_000_007,
            pose_known: 1,
            mount_known: 1,
            map_from_base: geometry::Pose::new(1.0, 2.0, 0.0).into(),
            ..PoseHeader::zeroed()
        };
        let said = Localization::of(Header::default(), &from, b"only fit 0.4");
        assert_eq!((said.state, said.alternatives), (2, 2));
        assert_eq!((said.since.sec, said.since.nanosec), (5, 7));
        assert_eq!(
            (&*said.map_id, &*said.reason),
            ("00000000000000ff", "only fit 0.4")
        );
        assert!(said.pose_known && said.pose.pose.position.y == 2.0);
        // Before the first scan, and with no map.
        (from.since_ns, from.places, from.map_id, from.mount_known) = (-1, 0, 0, 0);
        let said = Localization::of(Header::default(), &from, b"\xff");
        assert_eq!(
            (said.since, said.alternatives, &*said.map_id),
            (Time::default(), 0, "")
        );
        assert!(!said.pose_known && said.pose.pose.position.y == 0.0);
    }
}
