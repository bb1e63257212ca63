//! A topic to the robot.

use rustdds::RTPSEntity;
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;

use super::Member;
use super::node::Shown;
use super::quality;
use super::raw::{Raw, fields};
use crate::GatewayError;
use crate::rmw::Keeping;
use crate::rmw::description::TypeInfo;

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
            _shown: member.node().show_writer(writer.guid()),
            topic: topic.to_owned(),
            writer,
        })
    }

    /// Sends a message in CDR.
    pub(crate) fn send(&self, bytes: Vec<u8>) -> Result<(), GatewayError> {
        let sent = self.writer.write(fields(bytes), None);
        sent.map_err(|error| GatewayError::Send {
            topic: self.topic.clone(),
            reason: error.to_string(),
        })
    }
}
