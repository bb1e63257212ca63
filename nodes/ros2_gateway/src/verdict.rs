//! The tracker's verdict: as a topic of the robot, and for a fleet's master control.

use messages::PoseHeader;
use ros::backcast_msgs::Localization;
use transport::TransportError;
use zenoh::Wait;
use zenoh::bytes::Encoding;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_session::{KeyError, Report};

use crate::rmw::{Member, Publisher};
use crate::stamps::in_map;
use crate::topics::Topics;
use crate::{GatewayError, vda5050};

/// Publishers of the verdict, with one message per scan.
pub(crate) struct Verdict {
    topic: Publisher<Localization>,
    /// `None` if the robot does not use Zenoh.
    fleet: Option<ZenohPublisher<'static>>,
}

impl Verdict {
    pub(crate) fn open(member: &Member, topics: &Topics) -> Result<Self, GatewayError> {
        let fleet = member.session().map(|session| {
            let key = format!("vda5050/{}{}", member.domain(), topics.localization);
            let publisher = session.declare_publisher(key.clone());
            let publisher = publisher
                .congestion_control(CongestionControl::Drop)
                .encoding(Encoding::APPLICATION_JSON)
                .wait();
            publisher.map_err(KeyError::when("publish", &key))
        });
        Ok(Verdict {
            topic: Publisher::open_kept(member, &topics.localization, 1)?,
            fleet: fleet.transpose()?,
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
        let to_fleet = self.fleet.as_ref().map(|fleet| send_to(fleet, from));
        to_fleet.map_or(Ok(()), |outcome| report.outcome(outcome))
    }
}

fn send_to(fleet: &ZenohPublisher<'static>, from: &PoseHeader) -> Result<(), GatewayError> {
    let key = fleet.key_expr();
    let bytes = serde_json::to_vec(&vda5050::of(from)).map_err(GatewayError::encoding(key))?;
    let sent = fleet.put(bytes).wait();
    Ok(sent.map_err(KeyError::when("send on", key.as_str()))?)
}
