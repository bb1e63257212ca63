//! Errors between a node and its graph.
//!
//! Each variant says what was tried, what was found and what is allowed. The text of iceoryx2 is
//! the reason where only iceoryx2 knows more.

use std::path::PathBuf;

use crate::GraphName;

/// Error of the transport.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// Invalid name of a graph.
    #[error(
        "{name:?} is not a graph name: allowed are 1 to {} of a-z, 0-9, '-' and '_'",
        GraphName::CAPACITY
    )]
    GraphName {
        /// Name as given.
        name: String,
    },
    /// Invalid name of a node.
    #[error("{name:?} is not a node name: allowed are 1 to {capacity} bytes", capacity = messages::Name::CAPACITY)]
    NodeName {
        /// Name as given.
        name: String,
    },
    /// The folder of this user's graphs belongs to another user.
    #[error(
        "{} belongs to user {owner}, but this process runs as user {user}: remove it as its owner or as root, \
         for it is where this user's graphs meet",
        path.display()
    )]
    ForeignFolder {
        path: PathBuf,
        /// User id of the folder's owner.
        owner: u32,
        /// User id of this process.
        user: u32,
    },
    /// The path of this user's folder is not a folder.
    #[error("{} is not a folder (owner: user {owner}): remove it, for it is where this user's graphs meet", path.display())]
    NotAFolder {
        path: PathBuf,
        /// User id of the owner.
        owner: u32,
    },
    /// A file or folder of the graph could not be used.
    #[error("cannot {action} {}", path.display())]
    File {
        /// Verb of what was tried.
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    /// The process could not become a member of the graph.
    #[error("node {node} cannot join graph {graph} under {}: {reason}", root.display())]
    Join {
        node: String,
        graph: GraphName,
        /// Folder where the graph's processes meet.
        root: PathBuf,
        /// Error of iceoryx2.
        reason: String,
    },
    /// Signals could not be caught.
    #[error("cannot catch SIGINT and SIGTERM")]
    Signals(#[source] std::io::Error),
    /// Another process uses the topic with other types.
    #[error(
        "topic {topic} carries {found} in this graph, but this process expects {expected}: \
         build all nodes from one version and restart the graph"
    )]
    TypeMismatch {
        topic: &'static str,
        /// Header and items that this process was built with.
        expected: String,
        /// Header and items in use in the graph.
        found: String,
    },
    /// The topic could not be opened.
    #[error("cannot open topic {topic}: {reason}")]
    Open {
        topic: &'static str,
        /// Error of iceoryx2.
        reason: String,
    },
    /// The topic has its maximum number of publishers.
    #[error("topic {topic} has {limit} publishers already, which is the maximum")]
    TooManyPublishers {
        topic: &'static str,
        /// Maximum number of publishers.
        limit: usize,
    },
    /// The topic has its maximum number of subscribers.
    #[error("topic {topic} has {limit} subscribers already, which is the maximum")]
    TooManySubscribers {
        topic: &'static str,
        /// Maximum number of subscribers.
        limit: usize,
    },
    /// A publisher, a subscriber or a port of its wake-up channel could not be created.
    #[error("cannot create the {port} of topic {topic}: {reason}")]
    Port {
        topic: &'static str,
        /// Kind of port.
        port: &'static str,
        /// Error of iceoryx2.
        reason: String,
    },
    /// Shared memory is full.
    #[error(
        "shared memory is full: topic {topic} needs {needed} bytes, {} has {free} free; \
         remove files there or make it larger (docker run --shm-size, mount -o remount,size=)",
        path.display()
    )]
    SharedMemoryFull {
        topic: &'static str,
        /// Bytes needed.
        needed: u64,
        /// Bytes free.
        free: u64,
        /// Mount point of shared memory.
        path: PathBuf,
    },
    /// A sample of this many items exceeds any possible memory size.
    #[error("topic {topic} cannot carry a sample of {items} items of {item_bytes} bytes")]
    TooLarge {
        topic: &'static str,
        /// Number of items requested.
        items: usize,
        /// Size of an item in bytes.
        item_bytes: usize,
    },
    /// No memory could be loaned for a sample.
    #[error("cannot loan a sample of {items} items on topic {topic}: {reason}")]
    Loan {
        topic: &'static str,
        /// Number of items requested.
        items: usize,
        /// Error of iceoryx2.
        reason: String,
    },
    /// A sample could not be sent, or its subscribers could not be woken.
    #[error("cannot send on topic {topic}: {reason}")]
    Send {
        topic: &'static str,
        /// Error of iceoryx2.
        reason: String,
    },
    /// Samples could not be received.
    #[error("cannot receive on topic {topic}: {reason}")]
    Receive {
        topic: &'static str,
        /// Error of iceoryx2.
        reason: String,
    },
    /// Waiting for inputs failed.
    #[error("cannot wait for inputs: {reason}")]
    Wait {
        /// Error of iceoryx2.
        reason: String,
    },
    /// The processes of a graph could not be listed.
    #[error("cannot list the processes of graph {graph} under {}: {reason}", root.display())]
    List {
        graph: GraphName,
        /// Folder where the graph's processes meet.
        root: PathBuf,
        /// Error of iceoryx2.
        reason: String,
    },
    /// The process may not open as many files as a member needs.
    #[error(
        "this process may open {found} files at most, and a node needs up to {needed}: raise the limit \
         (ulimit -n {needed}, LimitNOFILE= of a unit, docker run --ulimit nofile=)"
    )]
    Descriptors {
        /// Hard limit of the process.
        found: u64,
        /// Limit that a member may need.
        needed: u64,
    },
    /// A file of another user has a name that this user's graph needs.
    #[error(
        "{} belongs to user {owner}, and the graph of user {user} needs that name: \
         have it removed, or give the graph another name (--graph)",
        path.display()
    )]
    ForeignFile {
        path: PathBuf,
        /// User id of the file's owner.
        owner: u32,
        /// User id of this process.
        user: u32,
    },
    /// Files by which the processes of a graph find each other were removed.
    #[error("files of the running graph were removed from {}: no node can join it any more", root.display())]
    Vanished {
        /// Folder where the graph's processes meet.
        root: PathBuf,
    },
    /// The graph's files cannot be removed while its processes are running.
    #[error("graph {graph} still runs: {}; stop it first", processes.join(", "))]
    StillRunning {
        graph: GraphName,
        /// Name and process id of each running node, or the lock that is held.
        processes: Vec<String>,
    },
}
