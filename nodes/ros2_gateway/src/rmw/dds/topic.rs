//! A topic to the robot, and a topic from it.

use rustdds::RTPSEntity;
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;

use super::node::Shown;
use super::raw::{Raw, fields};
use super::reader::Reader;
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::received::Sample;
use crate::rmw::{Sink, Source, Topic};

pub(super) struct Publisher {
    topic: String,
    writer: DataWriter<Bytes, Raw>,
    _shown: Shown,
}

impl Publisher {
    /// Opens the topic. If earlier messages are not taken in time, one that blocks waits a moment
    /// before it drops the next one.
    pub(super) fn open(
        member: &Member,
        topic: &Topic<'_>,
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let quality = quality::offered(topic.keeping, topic.depth, blocks);
        let name = format!("rt{}", topic.name);
        let writer = member.domain.writer(&name, &topic.info.name, &quality)?;
        Ok(Publisher {
            _shown: member.node.show_writer(writer.guid()),
            topic: topic.name.to_owned(),
            writer,
        })
    }
}

impl Sink for Publisher {
    fn send(&mut self, bytes: Vec<u8>) -> Result<(), GatewayError> {
        let sent = self.writer.write(fields(bytes), None);
        sent.map_err(GatewayError::sending(&self.topic))
    }
}

pub(super) struct Subscription {
    reader: Reader,
    depth: usize,
    _shown: Shown,
}

impl Subscription {
    pub(super) fn open(
        member: &Member,
        topic: &Topic<'_>,
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let quality = quality::requested(topic.keeping, topic.depth);
        let names = (&*format!("rt{}", topic.name), &*topic.info.name, topic.name);
        let waker = Some(member.waker.clone());
        let reader = member.domain.reader(names, &quality, waker, max_bytes)?;
        Ok(Subscription {
            _shown: member.node.show_reader(reader.guid()),
            reader,
            depth: topic.depth,
        })
    }
}

impl Source for Subscription {
    fn depth(&self) -> usize {
        self.depth
    }

    fn next(&self) -> Option<Result<Sample, GatewayError>> {
        let sample = self.reader.next()?;
        Some(sample.map(|sample| {
            let sender = sample.identity.writer_guid.to_bytes();
            let sequence = sample.identity.sequence_number.into();
            Sample {
                bytes: sample.bytes.into(),
                identity: Some((sender, sequence)),
            }
        }))
    }
}
