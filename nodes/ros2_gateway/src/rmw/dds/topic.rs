//! A topic to the robot, and a topic from it.

use rustdds::RTPSEntity;
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;
use transport::Graph;

use super::node::Shown;
use super::raw::{Raw, fields};
use super::reader::Reader;
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::Keeping;
use crate::rmw::description::TypeInfo;
use crate::rmw::received::Identity;

pub(crate) struct Publisher {
    topic: String,
    writer: DataWriter<Bytes, Raw>,
    _shown: Shown,
}

impl Publisher {
    /// Opens the topic. If earlier messages are not taken in time, one that blocks waits a moment
    /// before it drops the next one.
    pub(crate) fn open(
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        quality: (Keeping, usize),
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let quality = quality::offered(quality, blocks);
        let writer = member.writer((&format!("rt{topic}"), &info.name), &quality)?;
        Ok(Publisher {
            _shown: member.node.show_writer(writer.guid()),
            topic: topic.to_owned(),
            writer,
        })
    }

    pub(crate) fn send(&self, bytes: Vec<u8>) -> Result<(), GatewayError> {
        let sent = self.writer.write(fields(bytes), None);
        sent.map_err(GatewayError::sending(&self.topic))
    }
}

pub(crate) struct Subscription {
    reader: Reader,
    depth: usize,
    _shown: Shown,
}

impl Subscription {
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        (keeping, depth): (Keeping, usize),
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let quality = quality::requested((keeping, depth));
        let names = (&*format!("rt{topic}"), &*info.name, topic);
        let reader = member.reader(graph, names, &quality, max_bytes)?;
        Ok(Subscription {
            _shown: member.node.show_reader(reader.guid()),
            reader,
            depth,
        })
    }

    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    pub(crate) fn next<M>(
        &self,
        decode: impl FnOnce(&[u8], Option<Identity>) -> Result<M, GatewayError>,
    ) -> Option<Result<M, GatewayError>> {
        let sample = self.reader.next()?;
        Some(sample.and_then(|sample| {
            let sender = sample.identity.writer_guid.to_bytes();
            let sequence = sample.identity.sequence_number.into();
            decode(&sample.bytes, Some((sender, sequence)))
        }))
    }
}
