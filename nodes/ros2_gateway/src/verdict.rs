//! The tracker's verdict: as a topic of the robot, and for a fleet's master control.

use messages::PoseHeader;
use ros::backcast_msgs::Localization;
use transport::TransportError;
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_session::{KeyError, Report};

use crate::rmw_zenoh::{Member, Publisher};
use crate::stamps::in_map;
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
            .and_then(|header| self.topic.send(&Localization::of(header, from, words)));
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

#[cfg(test)]
mod tests {
    use ros::RosMessage;

    use super::*;

    #[test]
    fn the_definition_stands_in_the_document() {
        let (fields, _) = Localization::DEFINITION.split_once("====").unwrap();
        let document = include_str!("../../../docs/ros2.md");
        assert!(document.contains(fields), "docs/ros2.md lacks:\n{fields}");
    }
}
