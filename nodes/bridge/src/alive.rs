//! Signs of life: a liveliness token for the bridge, and one for each node whose health it
//! receives.
//!
//! Zenoh removes tokens when the process that holds them is killed or disconnected, and notifies
//! those who watch them.

use std::collections::BTreeMap;

use messages::{HealthHeader, NodeState, topic};
use transport::{Graph, Subscriber, TransportError, monotonic_ns};
use zenoh::liveliness::LivelinessToken;
use zenoh::{Session, Wait};
use zenoh_session::KeyError;

use crate::BridgeError;

/// Time without a report after which a node counts as dead, nanoseconds; nodes report every second.
const SILENCE_NS: i64 = 5_000_000_000;

pub(crate) struct Alive {
    session: Session,
    robot: String,
    _bridge: LivelinessToken,
    /// `None` if health is received from other machines, because the nodes are then not on this
    /// one.
    health: Option<Subscriber<topic::Health>>,
    nodes: BTreeMap<String, Node>,
}

struct Node {
    _token: LivelinessToken,
    received_ns: i64,
}

impl Alive {
    pub(crate) fn open(
        graph: &Graph,
        session: &Session,
        robot: &str,
        health_comes_in: bool,
    ) -> Result<Self, BridgeError> {
        let health = if health_comes_in {
            None
        } else {
            Some(graph.subscriber()?)
        };
        Ok(Alive {
            session: session.clone(),
            robot: robot.to_owned(),
            _bridge: declare(session, robot, None)?,
            health,
            nodes: BTreeMap::new(),
        })
    }

    /// Adds tokens for nodes that are alive, and drops those of nodes that are not.
    pub(crate) fn step(&mut self) -> Result<(), BridgeError> {
        let now_ns = monotonic_ns();
        while let Some(report) = self.next()? {
            let name = report.node.as_str();
            if report.state == NodeState::Stopped as u32 {
                self.nodes.remove(name);
            } else if network_payload::name(name).is_ok() {
                self.receive(name, report.sent_ns)?;
            }
        }
        self.nodes
            .retain(|_, node| now_ns.saturating_sub(node.received_ns) < SILENCE_NS);
        Ok(())
    }

    fn next(&self) -> Result<Option<HealthHeader>, TransportError> {
        let Some(health) = &self.health else {
            return Ok(None);
        };
        Ok(health.receive()?.map(|sample| *sample.header()))
    }

    fn receive(&mut self, name: &str, received_ns: i64) -> Result<(), BridgeError> {
        if let Some(node) = self.nodes.get_mut(name) {
            node.received_ns = received_ns;
            return Ok(());
        }
        let token = declare(&self.session, &self.robot, Some(name))?;
        let node = Node {
            _token: token,
            received_ns,
        };
        self.nodes.insert(name.to_owned(), node);
        Ok(())
    }
}

fn declare(
    session: &Session,
    robot: &str,
    node: Option<&str>,
) -> Result<LivelinessToken, BridgeError> {
    let key = network_payload::alive(robot, &session.zid().to_string(), node);
    let token = session.liveliness().declare_token(key.clone());
    Ok(token.wait().map_err(KeyError::when("be alive at", &key))?)
}
