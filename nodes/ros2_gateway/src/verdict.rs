//! The tracker's verdict: as a topic of the robot, and for a fleet's master control.

use messages::PoseHeader;
use ros::Text;
use ros::backcast_msgs::Localization;
use transport::TransportError;
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_session::{KeyError, Report};

use crate::rmw::{Keeping, Member, Publisher};
use crate::stamps::in_map;
use crate::topics::Topics;
use crate::{GatewayError, vda5050};

pub(crate) struct Verdict {
    topic: Publisher<Localization>,
    fleet: Fleet,
}

/// Destination of the verdict for a fleet's master control.
enum Fleet {
    /// A Zenoh key, with JSON.
    Key(ZenohPublisher<'static>),
    /// A topic of the robot, with text.
    Topic(Publisher<Text>),
}

impl Verdict {
    pub(crate) fn open(member: &Member, topics: &Topics) -> Result<Self, GatewayError> {
        let fleet = match member.session() {
            Some(session) => {
                let key = format!("vda5050/{}{}", member.domain(), topics.localization);
                let publisher = session.declare_publisher(key.clone());
                let publisher = publisher
                    .congestion_control(CongestionControl::Drop)
                    .encoding(Encoding::APPLICATION_JSON)
                    .wait();
                Fleet::Key(publisher.map_err(KeyError::when("publish", &key))?)
            }
            None => {
                let topic = format!("{}/vda5050", topics.localization);
                Fleet::Topic(Publisher::open(member, &topic, Keeping::Reliable, 1)?)
            }
        };
        Ok(Verdict {
            topic: Publisher::open(member, &topics.localization, Keeping::Kept, 1)?,
            fleet,
        })
    }

    /// Sends the tracker's result for a scan; `words` gives its reason as text.
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
        report.outcome(on_topic)?;
        report.outcome(self.fleet.send(from))
    }
}

impl Fleet {
    fn send(&mut self, from: &PoseHeader) -> Result<(), GatewayError> {
        let encoded = serde_json::to_string(&vda5050::of(from));
        let data = encoded.map_err(GatewayError::encoding("localization/vda5050"))?;
        match self {
            Fleet::Key(publisher) => {
                let sent = publisher.put(data).wait();
                let key = publisher.key_expr();
                Ok(sent.map_err(KeyError::when("send on", key.as_str()))?)
            }
            Fleet::Topic(publisher) => publisher.send(&Text { data }),
        }
    }
}
