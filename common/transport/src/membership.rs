//! What iceoryx2 must know so that one graph of one user stays apart from all
//! others: the folder where its processes meet and the prefix of its files.

use std::path::PathBuf;
use std::time::Duration;

use iceoryx2::prelude::{Config, FileName, Path as IoxPath, SemanticString};

use crate::GraphName;
use crate::root::{current_user, path_for};

/// Where Linux keeps POSIX shared memory.
pub(crate) const SHARED_MEMORY: &str = "/dev/shm";

/// How long a process waits for another one that is just creating a topic. A
/// loaded machine takes its time; one that died meanwhile never ends.
const CREATION_TIMEOUT: Duration = Duration::from_secs(5);

/// The places in which one graph of one user lives.
#[derive(Debug, Clone)]
pub(crate) struct Membership {
    pub(crate) graph: GraphName,
    pub(crate) root: PathBuf,
    pub(crate) prefix: String,
}

impl Membership {
    pub(crate) fn of(graph: &GraphName) -> Self {
        let user = current_user();
        Membership {
            graph: graph.clone(),
            root: path_for(user),
            prefix: prefix(user, graph),
        }
    }

    /// The configuration for every node of the graph. Files of the host are not
    /// consulted: two members that read different ones would not meet.
    pub(crate) fn config(&self) -> Config {
        // Both are made above of characters that are valid, and are short.
        let root = IoxPath::new(self.root.as_os_str().as_encoded_bytes())
            .expect("the folder of a user is a valid path");
        let prefix =
            FileName::new(self.prefix.as_bytes()).expect("a checked name makes a valid file name");
        let mut config = Config::default();
        config.global.set_root_path(&root);
        config.global.prefix = prefix;
        config.global.creation_timeout = CREATION_TIMEOUT;
        config
    }
}

/// The user is part of it, for all users share one folder of shared memory. The
/// dot ends it: no name holds one, so no graph's prefix begins another's.
fn prefix(user: u32, graph: &GraphName) -> String {
    format!("bc{user}_{graph}.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_prefix_begins_another_one() {
        let name = |text| GraphName::new(text).unwrap();
        let prefixes: Vec<String> = [(1, "a"), (1, "a_b"), (1, "ab"), (11, "a"), (1, "1_a")]
            .map(|(user, graph)| prefix(user, &name(graph)))
            .into();
        for (i, one) in prefixes.iter().enumerate() {
            for (j, other) in prefixes.iter().enumerate() {
                assert!(i == j || !one.starts_with(other), "{one} {other}");
            }
        }
    }

    #[test]
    fn the_longest_socket_path_fits() {
        // A socket's file is named after a 128-bit number in decimal.
        let graph = GraphName::new(&"x".repeat(GraphName::CAPACITY)).unwrap();
        let folder = path_for(u32::MAX);
        let file = format!("{}{}.event", prefix(u32::MAX, &graph), u128::MAX);
        let longest = folder.join(file);
        // `sun_path` has 108 bytes, the last of which is zero.
        assert!(longest.as_os_str().len() <= 107, "{}", longest.display());
    }
}
