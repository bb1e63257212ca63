//! The gateway as a participant of a domain of DDS.

use std::rc::Rc;
use std::time::Duration;

use rustdds::bytes::Bytes;
use rustdds::no_key::{DataWriter, SimpleDataReader};
use rustdds::{DomainParticipant, QosPolicies, RTPSEntity, Topic, TopicKind};
use transport::Graph;

use super::node::Node;
use super::raw::{Payload, Raw};
use super::reader::Reader;
use super::{discovery, entities, quality};
use crate::rmw::Keeping;
use crate::{Config, GatewayError};

/// Largest size of a participant's message about its nodes, bytes.
const MAX_INFO_BYTES: usize = 1 << 20;

/// Number of such messages that are queued until the next tick.
const MAX_INFOS: usize = 256;

/// Time to send the end of all topics and services before the participant ends, which would drop
/// what is not sent yet.
const FAREWELL: Duration = Duration::from_millis(100);

/// The gateway as a node of ROS that others see, until this is dropped.
pub(crate) struct Member {
    pub(crate) domain: u32,
    pub(super) node: Rc<Node>,
    publisher: rustdds::Publisher,
    subscriber: rustdds::Subscriber,
    pub(super) participant: DomainParticipant,
}

impl Member {
    /// Joins under the names of the configuration. A missing robot is no error.
    pub(crate) fn join(config: &Config) -> Result<Self, GatewayError> {
        let domain = config.domain()?;
        let id = u16::try_from(domain).unwrap_or(u16::MAX);
        let participant = discovery::builder(id).build().map_err(failed("join"))?;
        let quality = QosPolicies::qos_none();
        let publisher = participant.create_publisher(&quality);
        let publisher = publisher.map_err(failed("publish in"))?;
        let subscriber = participant.create_subscriber(&quality);
        let subscriber = subscriber.map_err(failed("subscribe in"))?;
        let parts = (&participant, &publisher, &subscriber);
        let node = node(parts, (&config.namespace, config.node()))?;
        Ok(Member {
            domain,
            node: Rc::new(node),
            publisher,
            subscriber,
            participant,
        })
    }

    /// Exchanges lists of nodes and their topics with other participants.
    pub(crate) fn tick(&self) {
        self.node.tick();
    }

    /// Opens a writer of bytes for these names of DDS.
    pub(super) fn writer(
        &self,
        (topic, kind): (&str, &str),
        quality: &QosPolicies,
    ) -> Result<DataWriter<Bytes, Raw>, GatewayError> {
        let topic = named(&self.participant, (topic, kind), quality)?;
        writer(&self.publisher, &topic)
    }

    /// Opens a reader of messages of at most `max_bytes` for these names of DDS; the log calls it
    /// `name`.
    pub(super) fn reader(
        &self,
        graph: &Graph,
        (topic, kind, name): (&str, &str, &str),
        quality: &QosPolicies,
        max_bytes: usize,
    ) -> Result<Reader, GatewayError> {
        let topic = named(&self.participant, (topic, kind), quality)?;
        let reader = reader(&self.subscriber, &topic)?;
        Ok(Reader::new(name, reader, Some(graph.waker()?), max_bytes))
    }
}

impl Drop for Member {
    fn drop(&mut self) {
        self.node.leave();
        std::thread::sleep(FAREWELL);
    }
}

type Parts<'a> = (
    &'a DomainParticipant,
    &'a rustdds::Publisher,
    &'a rustdds::Subscriber,
);

fn node(
    (participant, publisher, subscriber): Parts<'_>,
    (namespace, name): (&str, &str),
) -> Result<Node, GatewayError> {
    let namespace = match namespace.trim_end_matches('/') {
        "" => "/",
        namespace => namespace,
    };
    let names = (entities::TOPIC, entities::TYPE);
    let requested = quality::requested((Keeping::Kept, MAX_INFOS));
    let infos = reader(subscriber, &named(participant, names, &requested)?)?;
    let infos = Reader::new(entities::TOPIC, infos, None, MAX_INFO_BYTES);
    let offered = quality::offered((Keeping::Kept, 1), false);
    let writer = writer(publisher, &named(participant, names, &offered)?)?;
    Ok(Node::new(
        participant.guid(),
        (namespace, name),
        infos,
        writer,
    ))
}

fn named(
    participant: &DomainParticipant,
    (topic, kind): (&str, &str),
    quality: &QosPolicies,
) -> Result<Topic, GatewayError> {
    let (topic, kind) = (topic.to_owned(), kind.to_owned());
    let topic = participant.create_topic(topic, kind, quality, TopicKind::NoKey);
    topic.map_err(failed("name a topic in"))
}

fn writer(
    publisher: &rustdds::Publisher,
    topic: &Topic,
) -> Result<DataWriter<Bytes, Raw>, GatewayError> {
    let writer = publisher.create_datawriter_no_key(topic, None);
    writer.map_err(failed("publish in"))
}

fn reader(
    subscriber: &rustdds::Subscriber,
    topic: &Topic,
) -> Result<SimpleDataReader<Payload, Raw>, GatewayError> {
    let reader = subscriber.create_simple_datareader_no_key(topic, None);
    reader.map_err(failed("subscribe in"))
}

fn failed(action: &'static str) -> impl FnOnce(rustdds::dds::CreateError) -> GatewayError {
    move |error| GatewayError::Dds {
        action,
        reason: error.to_string(),
    }
}
