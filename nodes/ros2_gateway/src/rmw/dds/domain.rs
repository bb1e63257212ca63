//! A participant of a domain of DDS, and the topics that it opens.

use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use rustdds::{DomainParticipant, Publisher, QosPolicies, Subscriber, Topic, TopicKind};
use transport::Waker;

use super::discovery;
use super::raw::Raw;
use super::reader::Reader;
use crate::GatewayError;

pub(super) struct Domain {
    publisher: Publisher,
    subscriber: Subscriber,
    pub(super) participant: DomainParticipant,
}

impl Domain {
    pub(super) fn join(id: u32) -> Result<Self, GatewayError> {
        let id = u16::try_from(id).unwrap_or(u16::MAX);
        let participant = discovery::builder(id).build().map_err(failed("join"))?;
        let quality = QosPolicies::qos_none();
        let publisher = participant.create_publisher(&quality);
        let subscriber = participant.create_subscriber(&quality);
        Ok(Domain {
            publisher: publisher.map_err(failed("publish in"))?,
            subscriber: subscriber.map_err(failed("subscribe in"))?,
            participant,
        })
    }

    /// Opens a writer of bytes for these names of DDS.
    pub(super) fn writer(
        &self,
        topic: &str,
        kind: &str,
        quality: &QosPolicies,
    ) -> Result<DataWriter<Bytes, Raw>, GatewayError> {
        let topic = self.topic(topic, kind, quality)?;
        let writer = self.publisher.create_datawriter_no_key(&topic, None);
        writer.map_err(failed("publish in"))
    }

    /// Opens a reader of messages of at most `max_bytes` for these names of DDS, which wakes the
    /// graph if there is a waker; the log calls it `name`.
    pub(super) fn reader(
        &self,
        (topic, kind, name): (&str, &str, &str),
        quality: &QosPolicies,
        waker: Option<Waker>,
        max_bytes: usize,
    ) -> Result<Reader, GatewayError> {
        let topic = self.topic(topic, kind, quality)?;
        let reader = self
            .subscriber
            .create_simple_datareader_no_key(&topic, None);
        let reader = reader.map_err(failed("subscribe in"))?;
        Ok(Reader::new(name, reader, waker, max_bytes))
    }

    fn topic(&self, topic: &str, kind: &str, quality: &QosPolicies) -> Result<Topic, GatewayError> {
        let (topic, kind) = (topic.to_owned(), kind.to_owned());
        let topic = self
            .participant
            .create_topic(topic, kind, quality, TopicKind::NoKey);
        topic.map_err(failed("name a topic in"))
    }
}

fn failed(action: &'static str) -> impl FnOnce(rustdds::dds::CreateError) -> GatewayError {
    move |error| GatewayError::Refused(format!("cannot {action} the domain of DDS: {error}"))
}
