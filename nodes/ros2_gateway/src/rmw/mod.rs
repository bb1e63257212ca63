//! The robot's side: a node of ROS 2 with its topics and services, on any middleware.
//!
//! `zenoh` speaks the protocol of `rmw_zenoh`, and `dds` that of Fast DDS and Cyclone DDS; each is a
//! [`Middleware`], which carries bytes. `typed` has the messages and services on top of it. The
//! other files are pure and serve both.

mod dds;
mod description;
mod expected;
mod name;
mod received;
mod typed;
mod zenoh;

use ::zenoh::Session;
use transport::{Graph, TransportError};
use zenoh_session::Report;

use crate::middleware::{self, Rmw};
use crate::{Config, GatewayError};
use description::TypeInfo;
use expected::Expected;
pub(crate) use expected::Seen;
pub(crate) use name::resolve;
use received::Sample;
pub(crate) use typed::{Publisher, Service, Subscription, Watch, take};

/// Largest size of a service's request, bytes: names and values of some hundred parameters.
const MAX_REQUEST_BYTES: usize = 64 << 10;

/// Reliability and durability of a topic, in the words of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeping {
    /// Best effort, volatile: for sensors.
    Fresh,
    /// Reliable, volatile.
    Reliable,
    /// Reliable, transient local: late subscribers get the last messages of each sender.
    Kept,
}

/// A topic as a middleware opens it.
pub(crate) struct Topic<'a> {
    name: &'a str,
    info: &'a TypeInfo,
    keeping: Keeping,
    /// Number of messages that are kept for slow subscribers or late ones, or queued here.
    depth: usize,
}

/// The gateway as a node of ROS that others see, until this is dropped.
pub(crate) type Member = dyn Middleware;

/// A node of ROS that carries bytes.
pub(crate) trait Middleware {
    fn domain(&self) -> u32;

    /// Returns Zenoh's session; `None` on DDS.
    fn session(&self) -> Option<&Session> {
        None
    }

    /// Does periodic work; to be called regularly.
    fn tick(&self) {}

    /// Returns the missing routers; empty if all are there, or none is needed.
    fn missing(&self) -> String {
        String::new()
    }

    /// Opens a topic to the robot. On a slow network, one that blocks waits for a while; others
    /// drop the message.
    fn sink(&self, topic: &Topic<'_>, blocks: bool) -> Result<Box<dyn Sink>, GatewayError>;

    /// Opens a topic from the robot, with messages of at most `max_bytes`.
    fn source(&self, topic: &Topic<'_>, max_bytes: usize) -> Result<Box<dyn Source>, GatewayError>;

    /// Offers the service of this name and type.
    fn calls(&self, name: &str, info: &TypeInfo) -> Result<Box<dyn Calls>, GatewayError>;

    /// Watches the topics of other nodes.
    fn discovery(&self) -> Result<Box<dyn Discovery>, GatewayError>;
}

pub(crate) trait Sink {
    /// Sends a message in CDR with its header.
    fn send(&mut self, bytes: Vec<u8>) -> Result<(), GatewayError>;
}

pub(crate) trait Source {
    /// Returns the number of messages lost since the last call because the queue was full; 0 where
    /// the sequence numbers of a sender show gaps.
    fn dropped(&self) -> u64 {
        0
    }

    /// Returns the largest number of queued messages: taking no more at once keeps a fast topic from
    /// blocking the others.
    fn depth(&self) -> usize;

    /// Returns the next message, or an error for one that was too long to be queued.
    fn next(&self) -> Option<Result<Sample, GatewayError>>;
}

/// Answers a request with a response, both in CDR with its header.
type Respond<'a> = dyn FnMut(&[u8]) -> Result<Vec<u8>, GatewayError> + 'a;

pub(crate) trait Calls {
    /// Answers the queued calls with `respond`, and counts them; returns the number of answers.
    fn serve(&self, report: &mut Report, respond: &mut Respond<'_>) -> Result<u64, TransportError>;
}

pub(crate) trait Discovery {
    /// Returns the number of events dropped since the last call because there were too many.
    fn dropped(&self) -> u64 {
        0
    }

    /// Returns the next event of interest.
    fn next(&mut self, expected: &mut Expected) -> Option<Seen>;
}

/// Joins the robot's domain under the names of the configuration; `None` once the stop flag is set.
pub(crate) fn join(
    graph: &Graph,
    config: &Config,
    report: &mut Report,
) -> Result<Option<Box<Member>>, GatewayError> {
    let implementation = std::env::var("RMW_IMPLEMENTATION").unwrap_or_default();
    let (rmw, why) = middleware::chosen(config.rmw, &implementation);
    tracing::info!(?rmw, why, "the robot's middleware");
    Ok(match rmw {
        Rmw::Zenoh => match zenoh::Member::join(graph, config, report)? {
            Some(member) => Some(Box::new(member)),
            None => None,
        },
        Rmw::Dds => Some(Box::new(dds::Member::join(graph, config)?)),
    })
}
