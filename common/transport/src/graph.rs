//! A process's membership of a graph, which creates publishers, subscribers and health.

use std::cell::RefCell;
use std::fs::File;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use iceoryx2::node::Node;
use iceoryx2::prelude::{NodeBuilder, NodeName, SignalHandlingMode, ipc};
use messages::{HealthHeader, LogHeader, Name, Topic};
use nix::fcntl::Flock;

use crate::idle::IdlePublishers;
use crate::log_sender::LogSender;
use crate::losses::Losses;
use crate::membership::{Membership, alive};
use crate::signals::Signals;
use crate::{
    GraphName, Health, Publisher, Subscriber, TransportError, Waker, descriptors, log, log_lines,
    root,
};

/// Longest wait when joining, while another process frees a slot that may be needed.
const CLEANUP_WAIT: Duration = Duration::from_secs(1);

/// Membership of one process in one graph; it stays on the thread that joined.
pub struct Graph {
    node_name: String,
    membership: Membership,
    node: Node<ipc::Service>,
    signals: Signals,
    publishers: IdlePublishers,
    losses: Losses,
    /// Files that iceoryx2 has created for this process.
    own_files: Vec<PathBuf>,
    /// Lock against the cleaning of temporary folders; `None` while another process has it.
    root_lock: RefCell<Option<Flock<File>>>,
    /// Lock that marks this member as alive; dropped after the node.
    _alive: alive::Lock,
    /// Publisher of the log, if the process logs through `tracing`.
    log: Option<Rc<RefCell<LogSender>>>,
}

impl Graph {
    /// Joins the graph named by `BACKCAST_GRAPH`, as `node_name`.
    pub fn join(node_name: &str) -> Result<Graph, TransportError> {
        Self::join_named(node_name, &GraphName::from_environment()?)
    }

    /// Joins `graph` as `node_name`, a valid name, and cleans up after dead members.
    pub fn join_named(node_name: &str, graph: &GraphName) -> Result<Graph, TransportError> {
        log::route_to_tracing();
        if node_name.is_empty() || node_name.len() > Name::CAPACITY {
            let name = node_name.into();
            return Err(TransportError::NodeName { name });
        }
        descriptors::ensure()?;
        let root = root::prepare(root::current_user())?;
        let membership = Membership::of(graph).in_folder(root);
        membership.refuse_foreign_files(root::current_user())?;
        let root_lock = root::keep_from_cleaning(&membership.root);
        let alive = alive::as_member(&membership)?;
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
        membership.restrict_files();
        node.blocking_cleanup_dead_nodes(CLEANUP_WAIT);
        let own_files = membership.files_of_node(node.id().value());
        let mut graph = Graph {
            node_name: node_name.into(),
            membership,
            node,
            signals,
            publishers: IdlePublishers::default(),
            losses: Losses::default(),
            own_files,
            root_lock: RefCell::new(root_lock),
            _alive: alive,
            log: None,
        };
        if log_lines::are_kept() {
            // Its memory never grows, for the reason given in `health`.
            let publisher = graph.publisher_for(LogHeader::TEXT_CAPACITY)?;
            let sender = LogSender::new(node_name, publisher);
            graph.log = Some(Rc::new(RefCell::new(sender)));
        }
        Ok(graph)
    }

    pub fn name(&self) -> &GraphName {
        &self.membership.graph
    }

    /// Name under which this process joined.
    pub fn node_name(&self) -> &str {
        &self.node_name
    }

    /// Creates a publisher of topic `T`; fails on other types, too many, or full memory.
    pub fn publisher<T: Topic>(&self) -> Result<Publisher<T>, TransportError> {
        // It grows with the requested samples, so it starts small.
        self.publisher_for::<T>(1)
    }

    /// Creates a publisher for samples of up to `items` items; growing for larger ones may lose
    /// samples when the publisher ends.
    pub fn publisher_for<T: Topic>(&self, items: usize) -> Result<Publisher<T>, TransportError> {
        let publisher = Publisher::create(&self.node, items, self.losses.clone())?;
        self.publishers.add(publisher.for_event_loop());
        Ok(publisher)
    }

    /// Creates a subscriber of topic `T`; fails on other types, too many, or full memory.
    pub fn subscriber<T: Topic>(&self) -> Result<Subscriber<T>, TransportError> {
        Subscriber::create(&self.node)
    }

    /// Creates the reporter of this node's health.
    pub fn health(&self) -> Result<Health, TransportError> {
        // No error message makes it grow, so that the last message before its end is in memory that
        // its subscribers have mapped already.
        let publisher = self.publisher_for(HealthHeader::ERROR_CAPACITY)?;
        Health::new(
            &self.node_name,
            publisher,
            self.losses.clone(),
            self.log.clone(),
        )
    }

    /// Flag that SIGINT, SIGTERM and SIGHUP set, to be polled in long computations.
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        self.signals.flag()
    }

    /// Returns a handle with which another thread ends the sleep of [`Graph::run`].
    pub fn waker(&self) -> Result<Waker, TransportError> {
        self.signals.waker()
    }

    /// Frees the slots of dead members, as a supervisor should, and returns their number.
    pub fn cleanup_dead_nodes(&self) -> u64 {
        let mut lock = self.root_lock.borrow_mut();
        if lock.is_none() {
            // The process that had the lock may have ended.
            *lock = root::keep_from_cleaning(&self.membership.root);
        }
        self.node.try_cleanup_dead_nodes().cleanups
    }

    /// Publishes the lines logged since the last call, as [`Graph::run`] does after each step.
    pub fn send_log(&self) {
        if let Some(log) = &self.log {
            log.borrow_mut().send_waiting();
        }
    }

    /// Fails if files are gone by which others find this process, as [`TransportError::Vanished`].
    pub fn ensure_intact(&self) -> Result<(), TransportError> {
        let missing = |path: &PathBuf| matches!(path.try_exists(), Ok(false));
        if self.own_files.iter().any(missing) {
            let root = self.membership.root.clone();
            return Err(TransportError::Vanished { root });
        }
        Ok(())
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
        self.send_log();
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
