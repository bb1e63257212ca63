//! A process's membership of a graph.
//!
//! Makes what a node needs: ends of topics, a health reporter, a stop flag. It
//! sends and waits for nothing itself.

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
    losses: Losses,
    /// What iceoryx2 has put down for this process.
    own_files: Vec<PathBuf>,
    /// Against the cleaning of temporary folders, unless another process has it.
    root_lock: RefCell<Option<Flock<File>>>,
    /// Says that a member is alive; let go of after the node.
    _alive: alive::Lock,
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
        let publisher = Publisher::create(&self.node, items, self.losses.clone())?;
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
        Health::new(
            &self.node_name,
            publisher,
            self.losses.clone(),
            self.log.clone(),
        )
    }

    /// A flag that SIGINT, SIGTERM and SIGHUP set: to be looked at in long computations.
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
        let mut lock = self.root_lock.borrow_mut();
        if lock.is_none() {
            // Who had it may have gone.
            *lock = root::keep_from_cleaning(&self.membership.root);
        }
        self.node.try_cleanup_dead_nodes().cleanups
    }

    /// Sends what was logged since the last call, if the process logs through
    /// [`crate::node::start_logging`]. [`Graph::run`] does so after each step. Lines
    /// that cannot be sent are counted, and reported when others can.
    pub fn send_log(&self) {
        if let Some(log) = &self.log {
            log.borrow_mut().send_waiting();
        }
    }

    /// Whether the files by which others find this process are there: something that
    /// cleans temporary folders may have removed them.
    ///
    /// # Errors
    /// [`TransportError::Vanished`] if they are not.
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
