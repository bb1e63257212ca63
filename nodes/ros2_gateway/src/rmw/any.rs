//! The chosen middleware: each type wraps that of `zenoh` or that of `dds`.

use std::marker::PhantomData;

use ros::{RosMessage, RosService};
use serde::de::DeserializeOwned;
use transport::{Graph, TransportError};
use zenoh::Session;
use zenoh_session::Report;

use super::expected::Expected;
use super::received::{Identity, Received, Senders};
use super::{Keeping, Seen, dds, description, zenoh as rmw_zenoh};
use crate::middleware::{self, Rmw};
use crate::{Config, GatewayError};

/// The gateway as a node of ROS that others see, until this is dropped.
pub(crate) enum Member {
    Zenoh(Box<rmw_zenoh::Member>),
    Dds(Box<dds::Member>),
}

impl Member {
    /// Joins the robot's domain under the names of the configuration; `None` once the stop flag is
    /// set.
    pub(crate) fn join(
        graph: &Graph,
        config: &Config,
        report: &mut Report,
    ) -> Result<Option<Self>, GatewayError> {
        let implementation = std::env::var("RMW_IMPLEMENTATION").unwrap_or_default();
        let (rmw, why) = middleware::chosen(config.rmw, &implementation);
        tracing::info!(?rmw, why, "the robot's middleware");
        Ok(match rmw {
            Rmw::Zenoh => rmw_zenoh::Member::join(graph, config, report)?
                .map(|member| Member::Zenoh(Box::new(member))),
            Rmw::Dds => Some(Member::Dds(Box::new(dds::Member::join(config)?))),
        })
    }

    pub(crate) fn session(&self) -> Option<&Session> {
        match self {
            Member::Zenoh(member) => Some(&member.session),
            Member::Dds(_) => None,
        }
    }

    pub(crate) fn domain(&self) -> u32 {
        match self {
            Member::Zenoh(member) => member.domain,
            Member::Dds(member) => member.domain,
        }
    }

    /// Does periodic work; to be called regularly.
    pub(crate) fn tick(&self) {
        match self {
            Member::Zenoh(_) => {}
            Member::Dds(member) => member.tick(),
        }
    }

    /// Returns the missing routers; empty if all are there, or none is needed.
    pub(crate) fn missing(&self) -> String {
        match self {
            Member::Zenoh(member) => member.missing(),
            Member::Dds(_) => String::new(),
        }
    }
}

pub(crate) struct Publisher<M> {
    topic: String,
    sink: Sink,
    message: PhantomData<M>,
}

enum Sink {
    Zenoh(Box<rmw_zenoh::Publisher>),
    Dds(Box<dds::Publisher>),
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
        Self::with(member, topic, (keeping, depth), false)
    }

    /// Opens a reliable topic for rare messages that must arrive: sending waits for a slow network.
    pub(crate) fn open_blocking(
        member: &Member,
        topic: &str,
        depth: usize,
    ) -> Result<Self, GatewayError> {
        Self::with(member, topic, (Keeping::Reliable, depth), true)
    }

    fn with(
        member: &Member,
        topic: &str,
        quality: (Keeping, usize),
        blocks: bool,
    ) -> Result<Self, GatewayError> {
        let info = description::of_message::<M>()?;
        let named = (topic, &info);
        Ok(Publisher {
            topic: topic.to_owned(),
            sink: match member {
                Member::Zenoh(member) => {
                    let publisher = rmw_zenoh::Publisher::open(member, named, quality, blocks)?;
                    Sink::Zenoh(Box::new(publisher))
                }
                Member::Dds(member) => {
                    let publisher = dds::Publisher::open(member, named, quality, blocks)?;
                    Sink::Dds(Box::new(publisher))
                }
            },
            message: PhantomData,
        })
    }

    pub(crate) fn send(&mut self, message: &M) -> Result<(), GatewayError> {
        let bytes = ros::cdr::encode(message).map_err(GatewayError::encoding(&self.topic))?;
        match &mut self.sink {
            Sink::Zenoh(publisher) => publisher.send(bytes),
            Sink::Dds(publisher) => publisher.send(bytes),
        }
    }
}

/// A topic from the robot.
///
/// Losses are counted: those of the queue here by its limits, and those on the way by the sequence
/// numbers of the sender.
pub(crate) struct Subscription<M> {
    topic: String,
    source: Source,
    senders: Senders,
    received: bool,
    message: PhantomData<M>,
}

enum Source {
    Zenoh(Box<rmw_zenoh::Subscription>),
    Dds(Box<dds::Subscription>),
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
        let (named, quality) = ((topic, &info), (keeping, depth));
        Ok(Subscription {
            topic: topic.to_owned(),
            source: match member {
                Member::Zenoh(member) => Source::Zenoh(Box::new(rmw_zenoh::Subscription::open(
                    graph, member, named, quality, max_bytes,
                )?)),
                Member::Dds(member) => Source::Dds(Box::new(dds::Subscription::open(
                    graph, member, named, quality, max_bytes,
                )?)),
            },
            senders: Senders::default(),
            received: false,
            message: PhantomData,
        })
    }

    /// Returns the number of messages lost since the last call because the queue was full.
    pub(crate) fn dropped(&self) -> u64 {
        match &self.source {
            Source::Zenoh(subscription) => subscription.dropped(),
            // The sequence numbers of a sender show gaps.
            Source::Dds(_) => 0,
        }
    }

    /// Returns the largest number of queued messages: taking no more at once keeps a fast topic
    /// from blocking the others.
    pub(crate) fn depth(&self) -> usize {
        match &self.source {
            Source::Zenoh(subscription) => subscription.depth(),
            Source::Dds(subscription) => subscription.depth(),
        }
    }

    /// Returns an error for each message that was too long to be queued.
    pub(crate) fn next_too_long(&self) -> Option<GatewayError> {
        match &self.source {
            Source::Zenoh(subscription) => subscription.next_too_long(),
            // The error takes the place of the message.
            Source::Dds(_) => None,
        }
    }

    pub(crate) fn next(&mut self) -> Option<Received<M>> {
        let mut lost = 0;
        let decode = |bytes: &[u8], identity: Option<Identity>| {
            lost = identity.map_or(0, |identity| self.senders.lost_before(identity));
            ros::cdr::decode(bytes).map_err(GatewayError::decoding(&self.topic))
        };
        let message = match &self.source {
            Source::Zenoh(subscription) => subscription.next(decode),
            Source::Dds(subscription) => subscription.next(decode),
        }?;
        if message.is_ok() && !self.received {
            self.received = true;
            tracing::info!(topic = self.topic, "first message received");
        }
        Some(Received { message, lost })
    }
}

pub(crate) enum Service<S> {
    Zenoh(Box<rmw_zenoh::Service<S>>),
    Dds(Box<dds::Service<S>>),
}

impl<S: RosService> Service<S> {
    pub(crate) fn open(graph: &Graph, member: &Member, topic: &str) -> Result<Self, GatewayError> {
        Ok(match member {
            Member::Zenoh(member) => {
                Service::Zenoh(Box::new(rmw_zenoh::Service::open(graph, member, topic)?))
            }
            Member::Dds(member) => {
                Service::Dds(Box::new(dds::Service::open(graph, member, topic)?))
            }
        })
    }

    /// Answers the queued calls with `respond`, and counts them; returns the number of answers.
    pub(crate) fn serve(
        &self,
        report: &mut Report,
        respond: impl FnMut(S::Request) -> S::Response,
    ) -> Result<u64, TransportError> {
        match self {
            Service::Zenoh(service) => service.serve(report, respond),
            Service::Dds(service) => service.serve(report, respond),
        }
    }
}

pub(crate) struct Watch {
    pub(crate) expected: Expected,
    discovery: Discovery,
}

enum Discovery {
    Zenoh(rmw_zenoh::Watch),
    Dds(dds::Watch),
}

impl Watch {
    /// Opens a watch that reports subscribers of `subscribed`.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        subscribed: &str,
    ) -> Result<Self, GatewayError> {
        Ok(Watch {
            expected: Expected::new(subscribed),
            discovery: match member {
                Member::Zenoh(member) => Discovery::Zenoh(rmw_zenoh::Watch::open(graph, member)?),
                Member::Dds(member) => Discovery::Dds(dds::Watch::open(member)),
            },
        })
    }

    pub(crate) fn next(&mut self, member: &Member) -> Option<Seen> {
        match (&mut self.discovery, member) {
            (Discovery::Zenoh(watch), Member::Zenoh(member)) => {
                watch.next(member, &mut self.expected)
            }
            (Discovery::Dds(watch), Member::Dds(member)) => watch.next(member, &mut self.expected),
            _ => None,
        }
    }

    /// Passes new subscribers to `on_subscriber`, and reports publishers whose messages cannot be
    /// received.
    pub(crate) fn look(
        &mut self,
        member: &Member,
        report: &mut Report,
        mut on_subscriber: impl FnMut(String),
    ) -> Result<(), TransportError> {
        if let Discovery::Zenoh(watch) = &self.discovery {
            report.dropped(watch.dropped());
        }
        while let Some(seen) = self.next(member) {
            match seen {
                Seen::Subscriber(node) => on_subscriber(node),
                Seen::Publisher { .. } => {}
                Seen::Stranger(error) => report.refused(&error)?,
            }
        }
        Ok(())
    }
}
