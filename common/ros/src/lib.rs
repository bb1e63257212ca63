//! ROS 2 messages for recordings and robots: one file for each type, their bytes (`cdr`), and
//! conversions from and to messages of the graph. No I/O.
//!
//! A struct has the fields of its `.msg` in the same order, because CDR does not name fields. Next
//! to it are the definition as a constant, in the form that recordings store, and the conversion
//! from the message of the graph (`of`). Conversions to the plane reject values that are not finite
//! and quaternions that are no rotation.
//!
//! | file | conversion between graph and ROS |
//! |---|---|
//! | `measurements` | scans, odometry and true poses, to the graph |
//! | `poses`, `planar` | poses and transforms, to ROS |
//! | `diagnostics` | health, to ROS |
//! | `lasers` | names of lasers and topics, both ways |
//!
//! The types are written by hand although `hiroz-msgs` generates those of ROS: it depends on
//! `hiroz`, and with it on all of Zenoh, which takes longer to build than everything that reads or
//! writes a recording.

pub mod backcast_msgs;
mod bond;
pub mod cdr;
mod clock;
mod definition;
mod diagnostic_array;
pub mod diagnostics;
mod error;
mod geometry_msgs;
mod laser_scan;
pub mod lasers;
pub mod lifecycle_msgs;
mod log;
pub mod measurements;
pub mod nav2_msgs;
mod occupancy_grid;
mod odometry;
pub mod planar;
mod pose_array;
mod pose_stamped;
mod pose_with_covariance_stamped;
pub mod poses;
pub mod rcl_interfaces;
mod service;
mod std_msgs;
mod tf_message;
pub mod type_description_interfaces;

pub use bond::BondStatus;
pub use clock::Clock;
pub use diagnostic_array::{DiagnosticArray, DiagnosticStatus, KeyValue};
pub use error::ConversionError;
pub use geometry_msgs::{
    Mend, Point, Pose, PoseWithCovariance, Quaternion, Transform, Twist, TwistWithCovariance,
    Vector3,
};
pub use laser_scan::LaserScan;
pub use log::Log;
pub use occupancy_grid::{MapMetaData, OccupancyGridMsg};
pub use odometry::Odometry;
pub use pose_array::PoseArray;
pub use pose_stamped::PoseStamped;
pub use pose_with_covariance_stamped::PoseWithCovarianceStamped;
pub use service::{Empty, Nothing, RosService};
pub use std_msgs::{Header, Text, Time};
pub use tf_message::{TfMessage, TransformStamped};

/// A message type with its name and definition in recordings.
pub trait RosMessage: serde::Serialize {
    /// Name of the schema.
    const SCHEMA: &'static str;
    /// Text of the schema (`ros2msg`): its fields, then those of each type used.
    const DEFINITION: &'static str;
}

#[cfg(test)]
mod tests {
    use super::backcast_msgs::{
        Beam, Beams, Hypotheses, Hypothesis, Localization, Pose2D, Vote, Votes,
    };
    use super::*;
    use crate::cdr;

    fn header() -> Header {
        Header::new(
            Time {
                sec: 1_137_772_793,
                nanosec: 5,
            },
            "map",
        )
    }

    fn assert_survives<M>(message: &M)
    where
        M: RosMessage + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
    {
        let bytes = cdr::encode(message).unwrap();
        assert_eq!(&cdr::decode::<M>(&bytes).unwrap(), message);
    }

    #[test]
    fn messages_that_are_only_written_survive_their_bytes() {
        let pose = geometry::Pose::new(1.5, -2.0, 0.5);
        assert_survives(&PoseWithCovarianceStamped {
            header: header(),
            pose: PoseWithCovariance::from_planar(pose, [0.5; 9]),
        });
        assert_survives(&PoseArray {
            header: header(),
            poses: vec![Pose::from_planar(pose); 3],
        });
        assert_survives(&DiagnosticArray {
            header: header(),
            status: vec![DiagnosticStatus {
                level: DiagnosticStatus::WARN,
                name: "accumulator".to_owned(),
                message: "no map".to_owned(),
                hardware_id: "pid 7".to_owned(),
                values: vec![KeyValue {
                    key: "sent".to_owned(),
                    value: "3".to_owned(),
                }],
            }],
        });
    }

    #[test]
    fn a_log_line_survives_its_bytes() {
        assert_survives(&Log {
            stamp: header().stamp,
            level: 30,
            name: "accumulator".to_owned(),
            msg: "no map".to_owned(),
            line: 7,
            ..Log::default()
        });
    }

    #[test]
    fn our_own_messages_survive_their_bytes() {
        assert_survives(&Localization {
            header: header(),
            state: 2,
            probability: 0.75,
            since: header().stamp,
            alternatives: 3,
            map_id: "00ff".to_owned(),
            pose_known: true,
            pose: PoseWithCovariance::from_planar(geometry::Pose::new(1.0, 2.0, 0.5), [0.5; 9]),
            reason: "one place".to_owned(),
        });
        assert_survives(&Votes {
            header: header(),
            map_id: u64::MAX,
            truncated: true,
            mount_known: true,
            base_from_laser: Pose2D {
                x: 0.78,
                y: 0.0,
                theta: 0.1,
            },
            beam_arc_m: 0.2,
            votes: vec![
                Vote {
                    x: 1,
                    y: 2,
                    heading: 3,
                    intensity: u16::MAX,
                };
                5
            ],
            ..Votes::default()
        });
        assert_survives(&Hypotheses {
            header: header(),
            entered_ns: -1,
            verdict: 2,
            confidence: 0.25,
            hypotheses: vec![
                Hypothesis {
                    map_from_laser: geometry::Pose::new(1.0, 2.0, 3.0).into(),
                    covariance: [1e-4; 9],
                    score: 0.9,
                    support: 76,
                    ..Hypothesis::default()
                };
                2
            ],
            ..Hypotheses::default()
        });
        assert_survives(&Beams {
            header: header(),
            beams: vec![
                Beam {
                    range_m: f32::INFINITY,
                    fate: 4,
                    ..Beam::default()
                };
                3
            ],
            ..Beams::default()
        });
    }

    /// Definitions that use the same type contain the same text for it.
    #[test]
    fn definitions_agree_on_the_types_that_they_share() {
        let definitions = [
            LaserScan::DEFINITION,
            OccupancyGridMsg::DEFINITION,
            Odometry::DEFINITION,
            PoseStamped::DEFINITION,
            TfMessage::DEFINITION,
            PoseWithCovarianceStamped::DEFINITION,
            PoseArray::DEFINITION,
            DiagnosticArray::DEFINITION,
            Log::DEFINITION,
            BondStatus::DEFINITION,
            nav2_msgs::ParticleCloud::DEFINITION,
            lifecycle_msgs::TransitionEvent::DEFINITION,
            Votes::DEFINITION,
            Hypotheses::DEFINITION,
            Beams::DEFINITION,
            Localization::DEFINITION,
            Clock::DEFINITION,
            rcl_interfaces::ParameterEvent::DEFINITION,
        ];
        let mut known = std::collections::BTreeMap::new();
        for definition in definitions {
            let parts: Vec<&str> = definition.split(&"=".repeat(80)).collect();
            assert!(parts.len() > 1, "{definition}");
            for part in &parts[1..] {
                let (name, fields) = part.trim_start().split_once('\n').unwrap();
                assert!(name.starts_with("MSG: "), "{name}");
                let other = known.entry(name).or_insert(fields.trim_end());
                assert_eq!(*other, fields.trim_end(), "{name}");
            }
        }
    }
}
