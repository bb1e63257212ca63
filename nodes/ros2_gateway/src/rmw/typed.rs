//! Topics and services with the types of their messages, on any middleware.

use std::marker::PhantomData;

use ros::{RosMessage, RosService};
use serde::de::DeserializeOwned;
use transport::TransportError;
use zenoh_session::Report;

use super::expected::{Expected, Seen};
use super::received::{Sample, Senders};
use super::{Calls, Discovery, Keeping, MAX_REQUEST_BYTES, Member, Sink, Source, Topic, TypeInfo};
use crate::GatewayError;

pub(crate) struct Publisher<M> {
    topic: String,
    sink: Box<dyn Sink>,
    message: PhantomData<M>,
}

impl<M: RosMessage> Publisher<M> {
    /// Opens a topic that keeps the last `depth` messages, for slow subscribers or late ones.
    /// Messages are dropped if the robot's network is slower than the graph: most come with each
    /// scan, and only fresh ones are of use.
    pub(crate) fn open(
        member: &Member,
        topic: &str,
        keeping: Keeping,
        depth: usize,
    ) -> Result<Self, GatewayError> {
        Self::with(member, topic, keeping, depth, false)
    }

    /// Opens a reliable topic for rare messages that must arrive: sending waits for a slow network.
    pub(crate) fn open_blocking(
        member: &Member,
        topic: &str,
        depth: usize,
    ) -> Result<Self, GatewayError> {
        Self::with(member, topic, Keeping::Reliable, depth, true)
    }

    fn with(
        member: &Member,
        name: &str,
        keeping: Keeping,
        depth: usize,
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let topic = Topic {
            name,
            info: &TypeInfo::of(M::SCHEMA)?,
            keeping,
            depth,
        };
        Ok(Publisher {
            topic: name.to_owned(),
            sink: member.sink(&topic, blocks)?,
            message: PhantomData,
        })
    }

    pub(crate) fn send(&mut self, message: &M) -> Result<(), GatewayError> {
        let bytes = ros::cdr::encode(message).map_err(GatewayError::encoding(&self.topic))?;
        self.sink.send(bytes)
    }
}

/// A topic from the robot.
///
/// Losses are counted: those of the queue here by its limits, and those on the way by the sequence
/// numbers of the sender.
pub(crate) struct Subscription<M> {
    topic: String,
    source: Box<dyn Source>,
    senders: Senders,
    received: bool,
    message: PhantomData<M>,
}

impl<M: RosMessage + DeserializeOwned> Subscription<M> {
    /// Takes messages of at most `max_bytes`, and queues at most `depth` of them.
    pub(crate) fn open(
        member: &Member,
        name: &str,
        keeping: Keeping,
        depth: usize,
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let topic = Topic {
            name,
            info: &TypeInfo::of(M::SCHEMA)?,
            keeping,
            depth,
        };
        Ok(Subscription {
            topic: name.to_owned(),
            source: member.source(&topic, max_bytes)?,
            senders: Senders::default(),
            received: false,
            message: PhantomData,
        })
    }

    /// Reads a message, and counts those that were lost before it.
    fn read(&mut self, sample: &Sample, report: &mut Report) -> Result<M, GatewayError> {
        let identity = sample.identity;
        report.dropped(identity.map_or(0, |identity| self.senders.lost_before(identity)));
        let message = ros::cdr::decode(&sample.bytes.to_bytes());
        let message = message.map_err(GatewayError::decoding(&self.topic))?;
        if !std::mem::replace(&mut self.received, true) {
            tracing::info!(topic = self.topic, "first message received");
        }
        Ok(message)
    }
}

/// Passes queued messages to `each`, if there is a subscription, and counts rejected ones; fails only
/// if the graph fails.
pub(crate) fn take<M: RosMessage + DeserializeOwned>(
    subscription: Option<&mut Subscription<M>>,
    report: &mut Report,
    mut each: impl FnMut(M, &mut Report) -> Result<(), GatewayError>,
) -> Result<(), TransportError> {
    let Some(subscription) = subscription else {
        return Ok(());
    };
    report.dropped(subscription.source.dropped());
    for _ in 0..subscription.source.depth() {
        let Some(sample) = subscription.source.next() else {
            break;
        };
        report.received();
        let message = sample.and_then(|sample| subscription.read(&sample, report));
        match message.and_then(|message| each(message, report)) {
            Ok(()) => {}
            // A map that does not fit into shared memory is rejected.
            Err(GatewayError::Transport(error))
                if !matches!(error, TransportError::SharedMemoryFull { .. }) =>
            {
                return Err(error);
            }
            Err(error) => report.refused(&error)?,
        }
    }
    Ok(())
}

pub(crate) struct Service<S> {
    name: String,
    calls: Box<dyn Calls>,
    service: PhantomData<S>,
}

impl<S: RosService> Service<S> {
    pub(crate) fn open(member: &Member, name: &str) -> Result<Self, GatewayError> {
        Ok(Service {
            name: name.to_owned(),
            calls: member.calls(name, &TypeInfo::of(S::NAME)?)?,
            service: PhantomData,
        })
    }

    /// Answers the queued calls with `respond`, and counts them; returns the number of answers.
    pub(crate) fn serve(
        &self,
        report: &mut Report,
        mut respond: impl FnMut(S::Request) -> S::Response,
    ) -> Result<u64, TransportError> {
        let topic = &self.name;
        self.calls.serve(report, &mut |request| {
            let (found, most) = (request.len(), MAX_REQUEST_BYTES);
            if found > most {
                return Err(GatewayError::too_long(topic, found, most));
            }
            let request = ros::cdr::decode(request).map_err(GatewayError::decoding(topic))?;
            ros::cdr::encode(&respond(request)).map_err(GatewayError::encoding(topic))
        })
    }
}

pub(crate) struct Watch {
    pub(crate) expected: Expected,
    discovery: Box<dyn Discovery>,
}

impl Watch {
    /// Opens a watch that reports subscribers of `subscribed`.
    pub(crate) fn open(member: &Member, subscribed: &str) -> Result<Self, GatewayError> {
        Ok(Watch {
            expected: Expected::new(subscribed),
            discovery: member.discovery()?,
        })
    }

    pub(crate) fn next(&mut self) -> Option<Seen> {
        self.discovery.next(&mut self.expected)
    }

    /// Passes new subscribers to `on_subscriber`, and reports publishers whose messages cannot be
    /// received.
    pub(crate) fn look(
        &mut self,
        report: &mut Report,
        mut on_subscriber: impl FnMut(String),
    ) -> Result<(), TransportError> {
        report.dropped(self.discovery.dropped());
        while let Some(seen) = self.next() {
            match seen {
                Seen::Subscriber(node) => on_subscriber(node),
                Seen::Publisher { .. } => {}
                Seen::Stranger(error) => report.refused(&error)?,
            }
        }
        Ok(())
    }
}
