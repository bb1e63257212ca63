//! The gateway as a node of ROS in a domain of DDS.

use std::rc::Rc;
use std::time::Duration;

use transport::{Graph, Waker};

use super::domain::Domain;
use super::node::Node;
use crate::{Config, GatewayError};

/// Time to send the end of all topics and services before the participant ends, which would drop
/// what is not sent yet.
const FAREWELL: Duration = Duration::from_millis(100);

pub(crate) struct Member {
    pub(super) id: u32,
    pub(super) waker: Waker,
    pub(super) node: Rc<Node>,
    pub(super) domain: Domain,
}

impl Member {
    /// Joins under the names of the configuration. A missing robot is no error.
    pub(crate) fn join(graph: &Graph, config: &Config) -> Result<Self, GatewayError> {
        let id = config.domain()?;
        let domain = Domain::join(id)?;
        let node = Node::open(&domain, config.namespace(), config.node())?;
        Ok(Member {
            id,
            waker: graph.waker()?,
            node: Rc::new(node),
            domain,
        })
    }
}

impl Drop for Member {
    fn drop(&mut self) {
        self.node.leave();
        std::thread::sleep(FAREWELL);
    }
}
