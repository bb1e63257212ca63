//! Errors between a node and its graph, with the text of iceoryx2 where only it knows more.

use std::path::PathBuf;

use crate::GraphName;

#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    #[error(
        "{name:?} is not a graph name: allowed are 1 to {} of a-z, 0-9, '-' and '_'",
        GraphName::CAPACITY
    )]
    GraphName { name: String },
    #[error("{name:?} is not a node name: allowed are 1 to {capacity} bytes", capacity = messages::Name::CAPACITY)]
    NodeName { name: String },
    #[error(
        "{} belongs to user {owner}, but this process runs as user {user}: remove it as its owner or as root, \
         for it is where this user's graphs meet",
        path.display()
    )]
    ForeignFolder {
        path: PathBuf,
        owner: u32,
        user: u32,
    },
    #[error("{} is not a folder (owner: user {owner}): remove it, for it is where this user's graphs meet", path.display())]
    NotAFolder { path: PathBuf, owner: u32 },
    #[error("cannot {action} {}", path.display())]
    File {
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("node {node} cannot join graph {graph} under {}: {reason}", root.display())]
    Join {
        node: String,
        graph: GraphName,
        root: PathBuf,
        reason: String,
    },
    #[error("cannot catch SIGINT and SIGTERM")]
    Signals(#[source] std::io::Error),
    #[error(
        "topic {topic} carries {found} in this graph, but this process expects {expected}: \
         build all nodes from one version and restart the graph"
    )]
    TypeMismatch {
        topic: &'static str,
        expected: String,
        found: String,
    },
    #[error("topic {topic} has {limit} {ports} already, which is the maximum")]
    TooMany {
        topic: &'static str,
        ports: &'static str,
        limit: usize,
    },
    /// iceoryx2 failed; `action` is what was tried.
    #[error("cannot {action} topic {topic}: {reason}")]
    Topic {
        topic: &'static str,
        action: &'static str,
        reason: String,
    },
    #[error(
        "shared memory is full: topic {topic} needs {needed} bytes, {} has {free} free; \
         remove files there or make it larger (docker run --shm-size, mount -o remount,size=)",
        path.display()
    )]
    SharedMemoryFull {
        topic: &'static str,
        needed: u64,
        free: u64,
        path: PathBuf,
    },
    #[error("topic {topic} cannot carry a sample of {items} items of {item_bytes} bytes")]
    TooLarge {
        topic: &'static str,
        items: usize,
        item_bytes: usize,
    },
    #[error("cannot loan a sample of {items} items on topic {topic}: {reason}")]
    Loan {
        topic: &'static str,
        items: usize,
        reason: String,
    },
    #[error("cannot wait for inputs: {reason}")]
    Wait { reason: String },
    #[error("cannot list the processes of graph {graph} under {}: {reason}", root.display())]
    List {
        graph: GraphName,
        root: PathBuf,
        reason: String,
    },
    #[error(
        "this process may open {found} files at most, and a node needs up to {needed}: raise the limit \
         (ulimit -n {needed}, LimitNOFILE= of a unit, docker run --ulimit nofile=)"
    )]
    Descriptors { found: u64, needed: u64 },
    #[error(
        "{} belongs to user {owner}, and the graph of user {user} needs that name: \
         have it removed, or give the graph another name (--graph)",
        path.display()
    )]
    ForeignFile {
        path: PathBuf,
        owner: u32,
        user: u32,
    },
    #[error("files of the running graph were removed from {}: no node can join it any more", root.display())]
    Vanished { root: PathBuf },
    #[error("graph {graph} still runs: {}; stop it first", processes.join(", "))]
    StillRunning {
        graph: GraphName,
        processes: Vec<String>,
    },
}
