//! A process's membership of a graph.
//!
//! Makes what a node needs: ends of topics, a health reporter, a stop flag. It
//! sends and waits for nothing itself.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use iceoryx2::node::Node;
use iceoryx2::prelude::{NodeBuilder, NodeName, SignalHandlingMode, ipc};
use messages::{HealthHeader, LogHeader, Name, Topic};

use crate::idle::IdlePublishers;
use crate::log_sender::LogSender;
use crate::membership::Membership;
use crate::signals::Signals;
use crate::{
    GraphName, Health, Publisher, Subscriber, TransportError, Waker, log, log_lines, root,
    with_causes,
};

/// How long joining waits for another process that is cleaning up after a dead
/// one, whose place may be needed.
const CLEANUP_WAIT: Duration = Duration::from_secs(1);

/// One process's membership of one graph; it stays on the thread that joined.
pub struct Graph {
    node_name: String,
    membership: Membership,
    node: Node<ipc::Service>,
    signals: Signals,
    publishers: IdlePublishers,
    /// Where the process logs through `tracing`.
    log: Option<Rc<RefCell<LogSender>>>,
}

impl Graph {
    /// Joins the graph that `BACKCAST_GRAPH` names, as `node_name`.
    ///
    /// # Errors
    /// As [`Graph::join_named`], and if the variable holds no valid name.
    pub fn join(node_name: &str) -> Result<Graph, TransportError> {
        Self::join_named(node_name, &GraphName::from_environment()?)
    }

    /// Joins `graph` as `node_name`, and cleans up after members that died.
    ///
    /// # Errors
    /// If the name is unusable, this user's folder cannot be used, signals
    /// cannot be caught, or iceoryx2 refuses.
    pub fn join_named(node_name: &str, graph: &GraphName) -> Result<Graph, TransportError> {
        log::route_to_tracing();
        if node_name.is_empty() || node_name.len() > Name::CAPACITY {
            let name = node_name.into();
            return Err(TransportError::NodeName { name });
        }
        let membership = Membership::of(graph);
        root::prepare(&membership.root, root::current_user())?;
        let signals = Signals::catch()?;
        let failed = |reason: String| TransportError::Join {
            node: node_name.into(),
            graph: graph.clone(),
            root: membership.root.clone(),
            reason,
        };
        let name = NodeName::new(node_name).map_err(|e| failed(format!("{e:?}")))?;
        let node = NodeBuilder::new()
            .name(&name)
            .config(&membership.config())
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<ipc::Service>()
            .map_err(|e| failed(format!("{e:?}")))?;
        node.blocking_cleanup_dead_nodes(CLEANUP_WAIT);
        let mut graph = Graph {
            node_name: node_name.into(),
            membership,
            node,
            signals,
            publishers: IdlePublishers::default(),
            log: None,
        };
        if log_lines::are_kept() {
            // No line makes it grow, as with health.
            let publisher = graph.publisher_for(LogHeader::TEXT_CAPACITY)?;
            let sender = LogSender::new(node_name, publisher);
            graph.log = Some(Rc::new(RefCell::new(sender)));
        }
        Ok(graph)
    }

    /// The graph's name.
    #[must_use]
    pub fn name(&self) -> &GraphName {
        &self.membership.graph
    }

    /// The name under which this process joined.
    #[must_use]
    pub fn node_name(&self) -> &str {
        &self.node_name
    }

    /// A sender for topic `T`.
    ///
    /// # Errors
    /// If the topic carries other types, has its publishers already, or shared
    /// memory is full.
    pub fn publisher<T: Topic>(&self) -> Result<Publisher<T>, TransportError> {
        // It grows with what it is asked for, so it starts small.
        self.publisher_for::<T>(1)
    }

    /// A sender for topic `T` whose samples have up to `items` items: for samples of
    /// changing size, since a publisher that grows takes along what a subscriber has
    /// not looked at when it ends. It grows all the same if it is asked for more.
    ///
    /// # Errors
    /// As [`Graph::publisher`].
    pub fn publisher_for<T: Topic>(&self, items: usize) -> Result<Publisher<T>, TransportError> {
        let publisher = Publisher::create(&self.node, items)?;
        self.publishers.add(publisher.for_event_loop());
        Ok(publisher)
    }

    /// A receiver for topic `T`.
    ///
    /// # Errors
    /// If the topic carries other types, has its subscribers already, or shared
    /// memory is full.
    pub fn subscriber<T: Topic>(&self) -> Result<Subscriber<T>, TransportError> {
        Subscriber::create(&self.node)
    }

    /// A reporter of this node's health.
    ///
    /// # Errors
    /// As [`Graph::publisher`].
    pub fn health(&self) -> Result<Health, TransportError> {
        // No error message makes it grow: what it says last, just before it goes,
        // then lies in memory that its subscribers know already.
        let publisher = self.publisher_for(HealthHeader::ERROR_CAPACITY)?;
        Health::new(&self.node_name, publisher, self.log.clone())
    }

    /// A flag that SIGINT and SIGTERM set: to be looked at in long computations.
    #[must_use]
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        self.signals.flag()
    }

    /// A handle by which another thread ends the sleep of [`Graph::run`].
    ///
    /// # Errors
    /// If the process has no file descriptor left.
    pub fn waker(&self) -> Result<Waker, TransportError> {
        self.signals.waker()
    }

    /// Frees what members that died have left, so that others can take their
    /// places; returns how many there were. For a supervisor, now and then.
    pub fn cleanup_dead_nodes(&self) -> u64 {
        self.node.try_cleanup_dead_nodes().cleanups
    }

    /// Sends what was logged since the last call, if the process logs through
    /// [`crate::node::start_logging`]. [`Graph::run`] does so after each step.
    ///
    /// # Errors
    /// As [`Publisher::loan`] and [`crate::Loan::send`].
    pub fn send_log(&self) -> Result<(), TransportError> {
        match &self.log {
            Some(log) => log.borrow_mut().send_waiting(),
            None => Ok(()),
        }
    }

    pub(crate) fn signals(&self) -> &Signals {
        &self.signals
    }

    pub(crate) fn publishers(&self) -> &IdlePublishers {
        &self.publishers
    }
}

impl Drop for Graph {
    fn drop(&mut self) {
        if let Err(error) = self.send_log() {
            tracing::warn!("the last log lines were not sent: {}", with_causes(&error));
        }
    }
}

impl std::fmt::Debug for Graph {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Graph")
            .field("node", &self.node_name)
            .field("graph", &self.membership.graph)
            .finish_non_exhaustive()
    }
}
