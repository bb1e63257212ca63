//! A topic to the robot.

use std::marker::PhantomData;

use ros::RosMessage;
use transport::wall_ns;
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_session::KeyError;

use super::entity::{Endpoint, Kind};
use super::{Attachment, Keeping, Member, description};
use crate::GatewayError;

/// Sends messages that nobody gets who joins later.
pub(crate) struct Publisher<M> {
    endpoint: Endpoint,
    publisher: ZenohPublisher<'static>,
    _token: LivelinessToken,
    sequence: i64,
    message: PhantomData<M>,
}

impl<M: RosMessage> Publisher<M> {
    /// Reliable, with the last `depth` messages kept by those that are slow. What comes
    /// with each scan is dropped where the robot's network is slower than the graph: it
    /// is fresh or of no use.
    pub(crate) fn open(member: &Member, topic: &str, depth: usize) -> Result<Self, GatewayError> {
        Self::with(member, topic, depth, CongestionControl::Drop)
    }

    /// As [`Publisher::open`], for what comes seldom and must arrive: where the network
    /// is slow it is waited for, until Zenoh closes the connection.
    pub(crate) fn open_blocking(
        member: &Member,
        topic: &str,
        depth: usize,
    ) -> Result<Self, GatewayError> {
        Self::with(member, topic, depth, CongestionControl::Block)
    }

    fn with(
        member: &Member,
        topic: &str,
        depth: usize,
        congestion: CongestionControl,
    ) -> Result<Self, GatewayError> {
        let info = description::of_message::<M>()?;
        let quality = (Keeping::Reliable, depth);
        let endpoint = member.endpoint(Kind::Publisher, topic, &info, quality);
        let publisher = member
            .session()
            .declare_publisher(endpoint.key.clone())
            // Not express: each message would take one of the two batches of its
            // priority, so that a third at once is dropped, and Zenoh may go on to drop.
            .congestion_control(congestion)
            .wait();
        let publisher = publisher.map_err(KeyError::when("publish", &endpoint.key))?;
        Ok(Publisher {
            _token: member.show(&endpoint)?,
            endpoint,
            publisher,
            // As rmw_zenoh counts.
            sequence: 1,
            message: PhantomData,
        })
    }

    pub(crate) fn send(&mut self, message: &M) -> Result<(), GatewayError> {
        let bytes = ros::cdr::encode(message).map_err(|error| GatewayError::Encode {
            topic: self.endpoint.topic.clone(),
            reason: error.to_string(),
        })?;
        let attachment = Attachment {
            sequence: self.sequence,
            sent_ns: wall_ns(),
            sender: self.endpoint.sender,
        };
        self.sequence += 1;
        let sent = self.publisher.put(bytes).attachment(attachment.encode());
        let failed = KeyError::when("send on", &self.endpoint.key);
        Ok(sent.wait().map_err(failed)?)
    }
}
