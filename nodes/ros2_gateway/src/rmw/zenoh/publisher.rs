//! A topic to the robot.

use transport::wall_ns;
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};
use zenoh_session::KeyError;

use super::entity::{Endpoint, Kind};
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::Keeping;
use crate::rmw::description::TypeInfo;

pub(crate) struct Publisher {
    endpoint: Endpoint,
    /// One for nodes that know the type's hash, and one for those of ROS 2 Humble.
    sinks: [Sink; 2],
    _token: LivelinessToken,
    sequence: i64,
}

enum Sink {
    /// Late subscribers get no message.
    Volatile(ZenohPublisher<'static>),
    /// Late subscribers get the last messages.
    Kept(AdvancedPublisher<'static>),
}

impl Publisher {
    /// Opens the topic. On a slow network, one that blocks waits until Zenoh closes the connection;
    /// others drop the message.
    pub(crate) fn open(
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        quality: (Keeping, usize),
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let congestion = match blocks {
            true => CongestionControl::Block,
            false => CongestionControl::Drop,
        };
        Self::with(member, (topic, info), quality, |key| {
            let publisher = member.session().declare_publisher(key);
            // Not express: each message would take one of the two batches of its priority, so that
            // a third one at once is dropped, and Zenoh may go on dropping.
            let publisher = publisher.congestion_control(congestion);
            Ok(match quality {
                (Keeping::Fresh | Keeping::Reliable, _) => Sink::Volatile(publisher.wait()?),
                (Keeping::Kept, depth) => {
                    let publisher = publisher
                        .advanced()
                        .cache(CacheConfig::default().max_samples(depth))
                        // Otherwise each message would need a time of Zenoh's clock.
                        .sample_miss_detection(MissDetectionConfig::default())
                        // Lets subscribers that were connected late ask for the messages they
                        // missed.
                        .publisher_detection();
                    Sink::Kept(publisher.wait()?)
                }
            })
        })
    }

    fn with(
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        quality: (Keeping, usize),
        declare: impl Fn(String) -> zenoh::Result<Sink>,
    ) -> Result<Self, GatewayError> {
        let endpoint = member.endpoint(Kind::Publisher, topic, info, quality);
        let declared = |key: &String| declare(key.clone()).map_err(KeyError::when("publish", key));
        let sinks = [declared(&endpoint.key)?, declared(&endpoint.humble_key)?];
        Ok(Publisher {
            _token: member.show(&endpoint)?,
            endpoint,
            sinks,
            // Sequence numbers of rmw_zenoh begin with 1.
            sequence: 1,
        })
    }

    /// Sends a message in CDR.
    pub(crate) fn send(&mut self, bytes: Vec<u8>) -> Result<(), GatewayError> {
        let attachment = Attachment {
            sequence: self.sequence,
            sent_ns: wall_ns(),
            sender: self.endpoint.sender,
        };
        self.sequence += 1;
        let (bytes, attachment) = (ZBytes::from(bytes), attachment.encode());
        for sink in &self.sinks {
            let (bytes, attachment) = (bytes.clone(), attachment.clone());
            let sent = match sink {
                Sink::Volatile(publisher) => publisher.put(bytes).attachment(attachment).wait(),
                Sink::Kept(publisher) => publisher.put(bytes).attachment(attachment).wait(),
            };
            sent.map_err(KeyError::when("send on", &self.endpoint.key))?;
        }
        Ok(())
    }
}
