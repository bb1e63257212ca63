//! A topic from the robot.

use std::marker::PhantomData;

use ros::RosMessage;
use serde::de::DeserializeOwned;
use transport::Graph;

use super::node::Shown;
use super::reader::{Reader, Sample};
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::received::{Received, Senders};
use crate::rmw::{Keeping, description};

pub(crate) struct Subscription<M> {
    topic: String,
    reader: Reader,
    depth: usize,
    senders: Senders,
    received: bool,
    _shown: Shown,
    message: PhantomData<M>,
}

impl<M: RosMessage + DeserializeOwned> Subscription<M> {
    /// Takes messages of at most `max_bytes`.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        topic: &str,
        (keeping, depth): (Keeping, usize),
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let info = description::of_message::<M>()?;
        let quality = quality::requested((keeping, depth));
        let names = (&*format!("rt{topic}"), &*info.name, topic);
        let reader = member.reader(graph, names, &quality, max_bytes)?;
        Ok(Subscription {
            _shown: member.node().show_reader(reader.guid()),
            topic: topic.to_owned(),
            reader,
            depth,
            senders: Senders::default(),
            received: false,
            message: PhantomData,
        })
    }

    /// Returns the largest number of queued messages.
    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    pub(crate) fn next(&mut self) -> Option<Received<M>> {
        let mut lost = 0;
        let sample = self.reader.next()?;
        let message = sample.and_then(|sample| self.decode(&sample, &mut lost));
        if message.is_ok() && !self.received {
            self.received = true;
            tracing::info!(topic = self.topic, "first message received");
        }
        Some(Received { message, lost })
    }

    fn decode(&mut self, sample: &Sample, lost: &mut u64) -> Result<M, GatewayError> {
        let sequence = sample.identity.sequence_number.into();
        let sender = sample.identity.writer_guid.to_bytes();
        *lost = self.senders.lost_before(sender, sequence);
        ros::cdr::decode(&sample.bytes).map_err(|reason| GatewayError::Message {
            topic: self.topic.clone(),
            reason,
        })
    }
}
