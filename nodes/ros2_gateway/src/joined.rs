//! Both sides that are joined: the graph with its results, and the robot's domain.

use messages::topic;
use transport::{Graph, Input, Subscriber, TransportError};

use crate::Config;
use crate::rmw::Member;
use crate::topics::Topics;

#[derive(Clone, Copy)]
pub(crate) struct Joined<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) member: &'a Member,
    pub(crate) config: &'a Config,
    pub(crate) topics: &'a Topics,
}

/// Subscribers of the graph's results.
pub(crate) struct Results {
    pub(crate) hypotheses: Subscriber<topic::Hypotheses>,
    pub(crate) poses: Subscriber<topic::Tracked>,
    pub(crate) health: Subscriber<topic::Health>,
}

impl Results {
    pub(crate) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Results {
            hypotheses: graph.subscriber()?,
            poses: graph.subscriber()?,
            health: graph.subscriber()?,
        })
    }

    pub(crate) fn all(&self) -> [&dyn Input; 3] {
        [&self.hypotheses, &self.poses, &self.health]
    }
}
