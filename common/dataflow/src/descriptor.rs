//! A checked descriptor. Plain data; it starts and opens nothing.

use std::time::Duration;

use crate::Place;

#[derive(Debug, Clone, PartialEq)]
pub struct Dataflow {
    pub nodes: Vec<Node>,
}

impl Dataflow {
    /// Returns the first node with this executable.
    pub fn node(&self, executable: &str) -> Option<&Node> {
        let mut nodes = self.nodes.iter();
        nodes.find(|node| node.executable() == executable)
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Name of the node, unique in the graph.
    pub id: String,
    /// Executable: an absolute path, or relative to the descriptor's folder.
    pub path: String,
    /// Place of `path` in the file.
    pub path_place: Place,
    pub args: Vec<String>,
    /// Variables added to the environment of the node and of its build.
    pub env: Vec<(String, String)>,
    /// Build commands, run in this order before the node starts.
    pub build: Vec<Command>,
    pub inputs: Vec<Input>,
    /// Topics that it publishes, each once.
    pub outputs: Vec<String>,
    /// Suffixes of its outputs if it publishes several of a topic: `front` and `rear` for
    /// `scan_front` and `scan_rear`.
    pub streams: Vec<String>,
    pub restart: Restart,
}

impl Node {
    /// File name of the executable, by which options find their node.
    pub fn executable(&self) -> &str {
        self.path
            .rsplit_once('/')
            .map_or(&self.path, |(_, name)| name)
    }
}

#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Command {
    /// Program, looked up in `PATH` unless it has a slash.
    pub program: String,
    pub args: Vec<String>,
}

impl std::fmt::Display for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.program)?;
        self.args.iter().try_for_each(|arg| write!(f, " {arg}"))
    }
}

/// A topic that a node subscribes to, and the node that publishes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    pub topic: String,
    pub from: String,
    /// Suffix, if that node publishes several of the topic; else empty.
    pub stream: String,
}

/// Behaviour when a node ends by itself or is silent for too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restart {
    pub policy: RestartPolicy,
    /// Largest number of restarts within `window`; 0 for no limit.
    pub max_restarts: u32,
    /// Delay before the first restart; it doubles with each further restart.
    pub delay: Duration,
    pub max_delay: Duration,
    /// Time after which a restart no longer counts.
    pub window: Duration,
    /// Longest time without a heartbeat; then the node is killed, and restarted by its policy.
    pub health_timeout: Duration,
}

impl Restart {
    /// Settings if the descriptor has none.
    pub const DEFAULT: Restart = Restart {
        policy: RestartPolicy::Never,
        max_restarts: 0,
        delay: Duration::ZERO,
        max_delay: Duration::from_secs(5),
        window: Duration::from_secs(60),
        health_timeout: Duration::from_secs(15),
    };
    /// Settings for a node that recovers by a restart.
    pub const ON_FAILURE: Restart = Restart {
        policy: RestartPolicy::OnFailure,
        max_restarts: 15,
        delay: Duration::from_millis(200),
        max_delay: Duration::from_secs(3),
        ..Restart::DEFAULT
    };
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RestartPolicy {
    Never,
    /// If it failed: by an exit code other than 0, or a signal.
    OnFailure,
    /// Whenever it ends, also with exit code 0.
    Always,
}
