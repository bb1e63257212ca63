//! A topic from the robot.
//!
//! Losses are counted: those of the queue here by its limits, and those on the way by the sequence
//! numbers of the sender.

use std::marker::PhantomData;

use ros::RosMessage;
use serde::de::DeserializeOwned;
use transport::Graph;
use zenoh::liveliness::LivelinessToken;
use zenoh::sample::Sample;
use zenoh_session::{Past, Queue, QueueLimits};

use super::entity::Kind;
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::received::{Received, Senders};
use crate::rmw::{Keeping, description};

pub(crate) struct Subscription<M> {
    topic: String,
    /// One for nodes that know the type's hash, and one for those of ROS 2 Humble.
    queues: [Queue; 2],
    senders: Senders,
    received: bool,
    _token: LivelinessToken,
    message: PhantomData<M>,
}

impl<M: RosMessage + DeserializeOwned> Subscription<M> {
    /// Takes messages of at most `max_bytes`, and queues at most `depth` of them.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        topic: &str,
        keeping: Keeping,
        depth: usize,
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let info = description::of_message::<M>()?;
        let endpoint = member.endpoint(Kind::Subscription, topic, &info, (keeping, depth));
        let past = match keeping {
            Keeping::Fresh | Keeping::Reliable => Past::Gone,
            Keeping::Kept => Past::Last(depth),
        };
        let limits = QueueLimits::for_any(depth, max_bytes);
        let open = |key: &str| -> Result<Queue, GatewayError> {
            let waker = graph.waker()?;
            Ok(Queue::open(member.session(), key, past, limits, waker)?)
        };
        Ok(Subscription {
            topic: topic.to_owned(),
            queues: [open(&endpoint.key)?, open(&endpoint.humble_key)?],
            senders: Senders::default(),
            received: false,
            _token: member.show(&endpoint)?,
            message: PhantomData,
        })
    }

    /// Returns the number of messages lost since the last call because the queue was full.
    pub(crate) fn dropped(&self) -> u64 {
        self.queues.iter().map(Queue::dropped).sum()
    }

    /// Returns the largest number of queued messages.
    pub(crate) fn depth(&self) -> usize {
        self.queues
            .iter()
            .map(|queue| queue.limits().messages)
            .sum()
    }

    /// Returns an error for each message that was too long to be queued.
    pub(crate) fn next_too_long(&self) -> Option<GatewayError> {
        let mut queues = self.queues.iter();
        let (found, most) = queues
            .find_map(|queue| Some((queue.next_too_long()?, queue.limits().message_bytes)))?;
        Some(GatewayError::TooLong {
            topic: self.topic.clone(),
            found,
            most,
        })
    }

    pub(crate) fn next(&mut self) -> Option<Received<M>> {
        let sample = self.queues.iter().find_map(Queue::next)?;
        let mut lost = 0;
        let message = self.decode(&sample, &mut lost);
        if message.is_ok() && !self.received {
            self.received = true;
            tracing::info!(topic = self.topic, "first message received");
        }
        Some(Received { message, lost })
    }

    fn decode(&mut self, sample: &Sample, lost: &mut u64) -> Result<M, GatewayError> {
        // Scripts that use plain Zenoh may leave it out.
        if let Some(bytes) = sample.attachment() {
            let attachment = Attachment::decode(&self.topic, bytes)?;
            let Attachment {
                sender, sequence, ..
            } = attachment;
            *lost = self.senders.lost_before(sender, sequence);
        }
        let bytes = sample.payload().to_bytes();
        ros::cdr::decode(&bytes).map_err(|reason| GatewayError::Message {
            topic: self.topic.clone(),
            reason,
        })
    }
}
