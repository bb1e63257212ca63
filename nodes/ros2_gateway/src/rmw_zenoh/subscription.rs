//! A topic from the robot.
//!
//! What is lost is counted: here for want of limits, and before by the sender's own
//! numbers.

use std::collections::BTreeMap;
use std::marker::PhantomData;

use ros::RosMessage;
use serde::de::DeserializeOwned;
use transport::Graph;
use zenoh::liveliness::LivelinessToken;
use zenoh::sample::Sample;
use zenoh_session::{Past, Queue, QueueLimits};

use super::entity::Kind;
use super::{Attachment, Keeping, Member, description};
use crate::GatewayError;

/// Senders of a topic whose sequence is followed; who has more is not informed what it
/// lost.
const MAX_SENDERS: usize = 64;

/// Receives messages.
pub(crate) struct Subscription<M> {
    topic: String,
    /// Of nodes that know the type's hash, and of those of ROS 2 Humble.
    queues: [Queue; 2],
    /// The last sequence number of each sender.
    senders: BTreeMap<[u8; 16], i64>,
    received: bool,
    _token: LivelinessToken,
    message: PhantomData<M>,
}

/// One message, or why there is none, and how many were lost before it.
pub(crate) struct Received<M> {
    pub(crate) message: Result<M, GatewayError>,
    pub(crate) lost: u64,
}

impl<M: RosMessage + DeserializeOwned> Subscription<M> {
    /// Takes messages of at most `max_bytes`; `depth` of them wait.
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
            senders: BTreeMap::new(),
            received: false,
            _token: member.show(&endpoint)?,
            message: PhantomData,
        })
    }

    /// Messages that were lost because the queue was full since the last call.
    pub(crate) fn dropped(&self) -> u64 {
        self.queues.iter().map(Queue::dropped).sum()
    }

    /// Most messages that can wait: who takes no more at once keeps no other topic
    /// waiting, however fast they come.
    pub(crate) fn depth(&self) -> usize {
        self.queues
            .iter()
            .map(|queue| queue.limits().messages)
            .sum()
    }

    /// Why a message was not let in at all, for each such.
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
        // Scripts that speak Zenoh alone may leave it out.
        if let Some(bytes) = sample.attachment() {
            let attachment = Attachment::decode(&self.topic, bytes)?;
            *lost = self.lost_before(attachment);
        }
        let bytes = sample.payload().to_bytes();
        ros::cdr::decode(&bytes).map_err(|reason| GatewayError::Message {
            topic: self.topic.clone(),
            reason,
        })
    }

    fn lost_before(&mut self, attachment: Attachment) -> u64 {
        if self.senders.len() >= MAX_SENDERS && !self.senders.contains_key(&attachment.sender) {
            self.senders.clear();
        }
        let last = self.senders.insert(attachment.sender, attachment.sequence);
        let between = last.and_then(|last| attachment.sequence.checked_sub(last));
        // What came again, or late, is no loss.
        let between = between.and_then(|between| u64::try_from(between).ok());
        between.unwrap_or(0).saturating_sub(1)
    }
}
