//! What can go wrong between a node and its graph.
//!
//! Each variant says what was tried, what was found and what is allowed; the
//! words of iceoryx2 are kept as the reason where it alone knows more.

use std::path::PathBuf;

use crate::GraphName;

/// A failure of the transport.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// Not a name for a graph.
    #[error(
        "{name:?} is not a graph name: allowed are 1 to {} of a-z, 0-9, '-' and '_'",
        GraphName::CAPACITY
    )]
    GraphName {
        /// What was given.
        name: String,
    },
    /// Not a name for a node.
    #[error("{name:?} is not a node name: allowed are 1 to {capacity} bytes", capacity = messages::Name::CAPACITY)]
    NodeName {
        /// What was given.
        name: String,
    },
    /// The folder of this user's graphs belongs to somebody else.
    #[error(
        "{} belongs to user {owner}, but this process runs as user {user}: remove it as its owner or as root, \
         for it is where this user's graphs meet",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// The user id that owns it.
        owner: u32,
        /// The user id of this process.
        user: u32,
    },
    /// Something that is no folder stands where this user's folder should be.
    #[error("{} is not a folder (owner: user {owner}): remove it, for it is where this user's graphs meet", path.display())]
    NotAFolder {
        /// What is in the way.
        path: PathBuf,
        /// The user id that owns it.
        owner: u32,
    },
    /// A file or folder of the graph could not be used.
    #[error("cannot {action} {}", path.display())]
    File {
        /// What was tried, as a verb.
        action: &'static str,
        /// With what.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The process could not become a member of the graph.
    #[error("node {node} cannot join graph {graph} under {}: {reason}", root.display())]
    Join {
        /// The node.
        node: String,
        /// The graph.
        graph: GraphName,
        /// The folder where the graph's processes meet.
        root: PathBuf,
        /// What iceoryx2 says.
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
        /// The topic.
        topic: &'static str,
        /// Header and items that this process was built with.
        expected: String,
        /// Header and items that are in use.
        found: String,
    },
    /// The topic could not be opened.
    #[error("cannot open topic {topic}: {reason}")]
    Open {
        /// The topic.
        topic: &'static str,
        /// What iceoryx2 says.
        reason: String,
    },
    /// As many publishers as the topic allows are there already.
    #[error("topic {topic} has {limit} publishers already, which is the maximum")]
    TooManyPublishers {
        /// The topic.
        topic: &'static str,
        /// Most publishers at the same time.
        limit: usize,
    },
    /// As many subscribers as the topic allows are there already.
    #[error("topic {topic} has {limit} subscribers already, which is the maximum")]
    TooManySubscribers {
        /// The topic.
        topic: &'static str,
        /// Most subscribers at the same time.
        limit: usize,
    },
    /// A publisher or subscriber could not be made.
    #[error("cannot create the {port} of topic {topic}: {reason}")]
    Port {
        /// The topic.
        topic: &'static str,
        /// Publisher, subscriber, or one of the ends of its wake-up channel.
        port: &'static str,
        /// What iceoryx2 says.
        reason: String,
    },
    /// Shared memory has no room for what is to be written.
    #[error(
        "shared memory is full: topic {topic} needs {needed} bytes, {} has {free} free; \
         remove files there or make it larger (docker run --shm-size, mount -o remount,size=)",
        path.display()
    )]
    SharedMemoryFull {
        /// The topic.
        topic: &'static str,
        /// Bytes that are needed.
        needed: u64,
        /// Bytes that are free.
        free: u64,
        /// Where shared memory is mounted.
        path: PathBuf,
    },
    /// A sample of this many items has no size that a machine could hold.
    #[error("topic {topic} cannot carry a sample of {items} items of {item_bytes} bytes")]
    TooLarge {
        /// The topic.
        topic: &'static str,
        /// Items that were asked for.
        items: usize,
        /// Size of one.
        item_bytes: usize,
    },
    /// No memory could be loaned for a sample.
    #[error("cannot loan a sample of {items} items on topic {topic}: {reason}")]
    Loan {
        /// The topic.
        topic: &'static str,
        /// Items that were asked for.
        items: usize,
        /// What iceoryx2 says.
        reason: String,
    },
    /// A sample could not be sent, or its subscribers could not be woken.
    #[error("cannot send on topic {topic}: {reason}")]
    Send {
        /// The topic.
        topic: &'static str,
        /// What iceoryx2 says.
        reason: String,
    },
    /// Samples could not be taken.
    #[error("cannot receive on topic {topic}: {reason}")]
    Receive {
        /// The topic.
        topic: &'static str,
        /// What iceoryx2 says.
        reason: String,
    },
    /// Waiting for inputs failed.
    #[error("cannot wait for inputs: {reason}")]
    Wait {
        /// What iceoryx2 says.
        reason: String,
    },
    /// The processes of a graph could not be looked up.
    #[error("cannot list the processes of graph {graph} under {}: {reason}", root.display())]
    List {
        /// The graph.
        graph: GraphName,
        /// The folder where the graph's processes meet.
        root: PathBuf,
        /// What iceoryx2 says.
        reason: String,
    },
    /// The process may not open as many files as it needs.
    #[error(
        "this process may open {found} files at most, and a node needs up to {needed}: raise the limit \
         (ulimit -n {needed}, LimitNOFILE= of a unit, docker run --ulimit nofile=)"
    )]
    Descriptors {
        /// The hard limit.
        found: u64,
        /// What a member may need.
        needed: u64,
    },
    /// A file of another user stands where one of the graph belongs.
    #[error(
        "{} belongs to user {owner}, and the graph of user {user} needs that name: \
         have it removed, or give the graph another name (--graph)",
        path.display()
    )]
    ForeignFile {
        /// What is in the way.
        path: PathBuf,
        /// The user id that owns it.
        owner: u32,
        /// The user id of this process.
        user: u32,
    },
    /// Files by which the processes of a graph find each other have been removed.
    #[error("files of the running graph were removed from {}: no node can join it any more", root.display())]
    Vanished {
        /// The folder where the graph's processes meet.
        root: PathBuf,
    },
    /// The graph's files cannot be removed while processes use them.
    #[error("graph {graph} still runs: {}; stop it first", processes.join(", "))]
    StillRunning {
        /// The graph.
        graph: GraphName,
        /// Its living nodes: name and process.
        processes: Vec<String>,
    },
}
