//! A topic to the robot.

use std::marker::PhantomData;

use ros::RosMessage;
use rustdds::RTPSEntity;
use rustdds::bytes::Bytes;
use rustdds::no_key::DataWriter;

use super::Member;
use super::node::Shown;
use super::quality;
use super::raw::{Raw, fields};
use crate::GatewayError;
use crate::rmw::{Keeping, description};

pub(crate) struct Publisher<M> {
    topic: String,
    writer: DataWriter<Bytes, Raw>,
    _shown: Shown,
    message: PhantomData<M>,
}

impl<M: RosMessage> Publisher<M> {
    /// Opens the topic. If earlier messages are not taken in time, one that blocks waits a moment
    /// before it drops the next one.
    pub(crate) fn open(
        member: &Member,
        topic: &str,
        quality: (Keeping, usize),
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let info = description::of_message::<M>()?;
        let quality = quality::offered(quality, blocks);
        let writer = member.writer((&format!("rt{topic}"), &info.name), &quality)?;
        Ok(Publisher {
            _shown: member.node().show_writer(writer.guid()),
            topic: topic.to_owned(),
            writer,
            message: PhantomData,
        })
    }

    pub(crate) fn send(&self, message: &M) -> Result<(), GatewayError> {
        let bytes = ros::cdr::encode(message).map_err(|error| GatewayError::Encode {
            topic: self.topic.clone(),
            reason: error.to_string(),
        })?;
        let sent = self.writer.write(fields(bytes), None);
        sent.map_err(|error| GatewayError::Send {
            topic: self.topic.clone(),
            reason: error.to_string(),
        })
    }
}
