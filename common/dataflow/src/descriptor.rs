//! What a checked descriptor says. Plain data; it starts and opens nothing.

use std::time::Duration;

use crate::Place;

/// A whole graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Dataflow {
    /// In the order of the file.
    pub nodes: Vec<Node>,
}

/// One process of the graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Its name, unique in the graph.
    pub id: String,
    /// Its executable, absolute or from the descriptor's folder.
    pub path: String,
    /// Where `path` stands in the file.
    pub path_place: Place,
    /// Its arguments, split in words.
    pub args: Vec<String>,
    /// Added to its environment, and to that of its build.
    pub env: Vec<(String, String)>,
    /// Run one after the other before it starts.
    pub build: Vec<Command>,
    /// The topics that it takes.
    pub inputs: Vec<Input>,
    /// The topics that it sends, each once.
    pub outputs: Vec<String>,
    /// What distinguishes its outputs if it sends several of a topic: `front` and
    /// `rear` for `scan_front` and `scan_rear`.
    pub streams: Vec<String>,
    /// What happens when it ends.
    pub restart: Restart,
}

impl Node {
    /// The file name of the executable, by which options find their node.
    #[must_use]
    pub fn executable(&self) -> &str {
        self.path
            .rsplit_once('/')
            .map_or(&self.path, |(_, name)| name)
    }
}

/// A command line, split in words; the first is the program.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Command {
    /// Looked up in `PATH` unless it holds a slash.
    pub program: String,
    /// The words after it.
    pub args: Vec<String>,
}

impl std::fmt::Display for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.program)?;
        self.args.iter().try_for_each(|arg| write!(f, " {arg}"))
    }
}

/// A topic that a node takes, and the node that sends it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The topic.
    pub topic: String,
    /// The id of the node that sends it.
    pub from: String,
    /// Which one, where that node sends several of the topic; else empty.
    pub stream: String,
}

/// What happens when a node ends by itself, or is silent for too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restart {
    /// Whether it is started again.
    pub policy: RestartPolicy,
    /// How often at most within `window`; 0 for no limit.
    pub max_restarts: u32,
    /// Before the first restart; each further restart waits twice as long.
    pub delay: Duration,
    /// The longest wait before a restart.
    pub max_delay: Duration,
    /// Restarts that lie farther back do not count.
    pub window: Duration,
    /// How long a node may be without a sign of life before it is ended, and started
    /// again by its policy.
    pub health_timeout: Duration,
}

impl Restart {
    /// What holds where the descriptor says nothing.
    pub const DEFAULT: Restart = Restart {
        policy: RestartPolicy::Never,
        max_restarts: 0,
        delay: Duration::ZERO,
        max_delay: Duration::from_secs(5),
        window: Duration::from_secs(60),
        health_timeout: Duration::from_secs(15),
    };
    /// For a node that recovers by being started again.
    pub const ON_FAILURE: Restart = Restart {
        policy: RestartPolicy::OnFailure,
        max_restarts: 15,
        delay: Duration::from_millis(200),
        max_delay: Duration::from_secs(3),
        ..Restart::DEFAULT
    };
}

/// When a node that ended is started again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RestartPolicy {
    /// Never.
    Never,
    /// When it failed: a status other than 0, or a signal.
    OnFailure,
    /// Whenever it ends, also with status 0.
    Always,
}

impl RestartPolicy {
    /// Each policy and its name in the file.
    pub(crate) const NAMES: [(&str, RestartPolicy); 3] = [
        ("never", RestartPolicy::Never),
        ("on-failure", RestartPolicy::OnFailure),
        ("always", RestartPolicy::Always),
    ];
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_executable_is_the_last_part_of_the_path() {
        let node = |path: &str| {
            let text = format!("nodes: [{{id: a, path: {path}}}]");
            crate::parse(&text, &crate::Topics::default())
                .unwrap()
                .nodes
                .remove(0)
        };
        assert_eq!(node("target/release/replayer").executable(), "replayer");
        assert_eq!(node("replayer").executable(), "replayer");
    }
}
