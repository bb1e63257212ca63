//! A topic from the robot.

use transport::Graph;
use zenoh::liveliness::LivelinessToken;
use zenoh_session::{Past, Queue, QueueLimits};

use super::entity::Kind;
use super::{Attachment, Member};
use crate::GatewayError;
use crate::rmw::Keeping;
use crate::rmw::description::TypeInfo;
use crate::rmw::received::Identity;

pub(crate) struct Subscription {
    topic: String,
    /// One for nodes that know the type's hash, and one for those of ROS 2 Humble.
    queues: [Queue; 2],
    _token: LivelinessToken,
}

impl Subscription {
    /// Takes messages of at most `max_bytes`, and queues at most `depth` of them.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        (keeping, depth): (Keeping, usize),
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let endpoint = member.endpoint(Kind::Subscription, topic, info, (keeping, depth));
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
            _token: member.show(&endpoint)?,
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

    /// Passes the next message to `decode`.
    pub(crate) fn next<M>(
        &self,
        decode: impl FnOnce(&[u8], Option<Identity>) -> Result<M, GatewayError>,
    ) -> Option<Result<M, GatewayError>> {
        let sample = self.queues.iter().find_map(Queue::next)?;
        // Scripts that use plain Zenoh may leave it out.
        let attachment = sample.attachment();
        let attachment = attachment.map(|bytes| Attachment::decode(&self.topic, bytes));
        Some(attachment.transpose().and_then(|attachment| {
            let identity = attachment.map(|of| (of.sender, of.sequence));
            decode(&sample.payload().to_bytes(), identity)
        }))
    }
}
