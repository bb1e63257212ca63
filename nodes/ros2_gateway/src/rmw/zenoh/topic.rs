//! A topic to the robot, and a topic from it.

use transport::wall_ns;
use zenoh::Wait;
use zenoh::bytes::ZBytes;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::Publisher as ZenohPublisher;
use zenoh::qos::CongestionControl;
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};
use zenoh_session::{KeyError, Past, Queue, QueueLimits};

use super::entity::{Endpoint, Kind};
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::received::Sample;
use crate::rmw::{self, Keeping, Topic};

pub(super) struct Publisher {
    endpoint: Endpoint,
    /// One for nodes that know the type's hash, and one for those of ROS 2 Humble.
    sinks: [Sink; 2],
    _token: LivelinessToken,
    sequence: i64,
}

enum Sink {
    Volatile(ZenohPublisher<'static>),
    Kept(AdvancedPublisher<'static>),
}

impl Publisher {
    /// Opens the topic. On a slow network, one that blocks waits until Zenoh closes the connection;
    /// others drop the message.
    pub(super) fn open(
        member: &Member,
        topic: &Topic<'_>,
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let congestion = match blocks {
            true => CongestionControl::Block,
            false => CongestionControl::Drop,
        };
        let endpoint = member.endpoint(Kind::Publisher, topic);
        let declare = |key: &String| -> zenoh::Result<Sink> {
            let publisher = member.session.declare_publisher(key.clone());
            // Not express: each message would take one of the two batches of its priority, so that
            // a third one at once is dropped, and Zenoh may go on dropping.
            let publisher = publisher.congestion_control(congestion);
            Ok(match topic.keeping {
                Keeping::Fresh | Keeping::Reliable => Sink::Volatile(publisher.wait()?),
                Keeping::Kept => {
                    let publisher = publisher
                        .advanced()
                        .cache(CacheConfig::default().max_samples(topic.depth))
                        // Otherwise each message would need a time of Zenoh's clock.
                        .sample_miss_detection(MissDetectionConfig::default())
                        // Lets subscribers that were connected late ask for the messages they
                        // missed.
                        .publisher_detection();
                    Sink::Kept(publisher.wait()?)
                }
            })
        };
        let declared = |key: &String| declare(key).map_err(KeyError::when("publish", key));
        let sinks = [declared(&endpoint.key)?, declared(&endpoint.humble_key)?];
        Ok(Publisher {
            _token: member.show(&endpoint)?,
            endpoint,
            sinks,
            // Sequence numbers of rmw_zenoh begin with 1.
            sequence: 1,
        })
    }
}

impl rmw::Sink for Publisher {
    fn send(&mut self, bytes: Vec<u8>) -> Result<(), GatewayError> {
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

pub(super) struct Subscription {
    topic: String,
    /// One for nodes that know the type's hash, and one for those of ROS 2 Humble.
    queues: [Queue; 2],
    _token: LivelinessToken,
}

impl Subscription {
    pub(super) fn open(
        member: &Member,
        topic: &Topic<'_>,
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let endpoint = member.endpoint(Kind::Subscription, topic);
        let past = match topic.keeping {
            Keeping::Fresh | Keeping::Reliable => Past::Gone,
            Keeping::Kept => Past::Last(topic.depth),
        };
        let limits = QueueLimits::for_any(topic.depth, max_bytes);
        let open = |key: &str| -> Result<Queue, GatewayError> {
            let waker = member.waker.clone();
            Ok(Queue::open(&member.session, key, past, limits, waker)?)
        };
        Ok(Subscription {
            topic: topic.name.to_owned(),
            queues: [open(&endpoint.key)?, open(&endpoint.humble_key)?],
            _token: member.show(&endpoint)?,
        })
    }

    /// Returns an error for each message that was too long to be queued.
    fn next_too_long(&self) -> Option<GatewayError> {
        let mut queues = self.queues.iter();
        let (found, most) = queues
            .find_map(|queue| Some((queue.next_too_long()?, queue.limits().message_bytes)))?;
        Some(GatewayError::too_long(&self.topic, found, most))
    }
}

impl rmw::Source for Subscription {
    fn dropped(&self) -> u64 {
        self.queues.iter().map(Queue::dropped).sum()
    }

    fn depth(&self) -> usize {
        self.queues
            .iter()
            .map(|queue| queue.limits().messages)
            .sum()
    }

    fn next(&self) -> Option<Result<Sample, GatewayError>> {
        if let Some(error) = self.next_too_long() {
            return Some(Err(error));
        }
        let sample = self.queues.iter().find_map(Queue::next)?;
        // Scripts that use plain Zenoh may leave it out.
        let attachment = sample.attachment();
        let attachment = attachment.map(|bytes| Attachment::decode(&self.topic, bytes));
        Some(attachment.transpose().map(|attachment| Sample {
            bytes: sample.payload().clone(),
            identity: attachment.map(|of| (of.sender, of.sequence)),
        }))
    }
}
