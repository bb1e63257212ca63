//! The tracker's verdict: as a topic of the robot, and for a fleet's master control.

use messages::PoseHeader;
use ros::backcast_msgs::Localization;
use ros::{Header, PoseWithCovariance, Time, planar};
use transport::TransportError;
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_session::{KeyError, Report};

use crate::outgoing::in_map;
use crate::rmw_zenoh::{Member, Publisher};
use crate::topics::Topics;
use crate::{GatewayError, vda5050};

/// Sends it, once a scan.
pub(crate) struct Verdict {
    topic: Publisher<Localization>,
    fleet: ZenohPublisher<'static>,
}

impl Verdict {
    pub(crate) fn open(member: &Member, topics: &Topics) -> Result<Self, GatewayError> {
        let key = format!("vda5050/{}{}", member.domain(), topics.localization);
        let publisher = member.session().declare_publisher(key.clone());
        let publisher = publisher
            .congestion_control(CongestionControl::Drop)
            .encoding(Encoding::APPLICATION_JSON)
            .wait();
        Ok(Verdict {
            topic: Publisher::open_kept(member, &topics.localization, 1)?,
            fleet: publisher.map_err(KeyError::when("publish", &key))?,
        })
    }

    /// Sends what the tracker says of a scan, with its words.
    pub(crate) fn send(
        &mut self,
        from: &PoseHeader,
        words: &[u8],
        map_frame: &str,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        if from.from_scan != 1 {
            return Ok(());
        }
        let on_topic = in_map(from.stamp, map_frame)
            .and_then(|header| self.topic.send(&localization(header, from, words)));
        for outcome in [on_topic, self.send_to_fleet(from)] {
            match outcome {
                Ok(()) => report.sent(),
                Err(error) => report.refused(&error)?,
            }
        }
        Ok(())
    }

    fn send_to_fleet(&self, from: &PoseHeader) -> Result<(), GatewayError> {
        let key = self.fleet.key_expr();
        let bytes = serde_json::to_vec(&vda5050::of(from)).map_err(|error| {
            let (topic, reason) = (key.to_string(), error.to_string());
            GatewayError::Encode { topic, reason }
        })?;
        let sent = self.fleet.put(bytes).wait();
        Ok(sent.map_err(KeyError::when("send on", key.as_str()))?)
    }
}

/// The map's id as texts have it; empty where there is no map.
pub(crate) fn map_id(from: &PoseHeader) -> String {
    match from.map_id {
        0 => String::new(),
        id => format!("{id:016x}"),
    }
}

fn localization(header: Header, from: &PoseHeader, words: &[u8]) -> Localization {
    // The pose of a laser is not the robot's.
    let pose_known = from.pose_known == 1 && from.mount_known == 1;
    let pose = match pose_known {
        true => planar::estimate(from.map_from_base.into(), from.base_covariance),
        false => PoseWithCovariance::default(),
    };
    Localization {
        header,
        // There are four states.
        state: u8::try_from(from.state).unwrap_or(u8::MAX),
        probability: from.probability,
        since: Time::from_ns(from.since_ns.max(0)).unwrap_or_default(),
        alternatives: from.places.saturating_sub(1),
        map_id: map_id(from),
        pose_known,
        pose,
        reason: String::from_utf8_lossy(words).into_owned(),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, TrackState};
    use ros::RosMessage;

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
            map_from_base: Pose2 {
                x: 1.0,
                y: 2.0,
                yaw: 0.0,
            },
            ..PoseHeader::zeroed()
        };
        let said = localization(Header::default(), &from, b"only fit 0.4");
        assert_eq!((said.state, said.alternatives), (2, 2));
        assert_eq!((said.since.sec, said.since.nanosec), (5, 7));
        assert_eq!(
            (&*said.map_id, &*said.reason),
            ("00000000000000ff", "only fit 0.4")
        );
        assert!(said.pose_known && said.pose.pose.position.y == 2.0);
        // Before the first scan, and with no map.
        (from.since_ns, from.places, from.map_id, from.mount_known) = (-1, 0, 0, 0);
        let said = localization(Header::default(), &from, b"\xff");
        assert_eq!(
            (said.since, said.alternatives, &*said.map_id),
            (Time::default(), 0, "")
        );
        assert!(!said.pose_known && said.pose.pose.position.y == 0.0);
    }

    #[test]
    fn the_definition_stands_in_the_document() {
        let (fields, _) = Localization::DEFINITION.split_once("====").unwrap();
        let document = include_str!("../../../docs/ros2.md");
        assert!(document.contains(fields), "docs/ros2.md lacks:\n{fields}");
    }
}
