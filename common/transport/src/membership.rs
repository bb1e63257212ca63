//! Separates one graph of one user from all others by folder and prefix of its files.

pub(crate) mod alive;

use std::fs::{DirEntry, Permissions, read_dir, set_permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

use iceoryx2::prelude::{Config, FileName, Path as IoxPath, SemanticString};

use crate::root::{current_user, path_for};
use crate::{GraphName, TransportError};

pub use alive::Claim;
use alive::{LAUNCHER, LockedFiles};

/// Mount point of POSIX shared memory on Linux.
pub(crate) const SHARED_MEMORY: &str = "/dev/shm";

const CONTROL: &str = "control";

/// Longest wait for another process that creates a topic; one that died never finishes.
const CREATION_TIMEOUT: Duration = Duration::from_secs(5);

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

    pub(crate) fn in_folder(self, root: PathBuf) -> Self {
        Membership { root, ..self }
    }

    /// Fails if another user has files with this graph's prefix in shared memory.
    pub(crate) fn refuse_foreign_files(&self, user: u32) -> Result<(), TransportError> {
        for path in self.shared_files() {
            let Ok(found) = path.symlink_metadata() else {
                continue;
            };
            let owner = found.uid();
            if owner != user {
                return Err(TransportError::ForeignFile { path, owner, user });
            }
        }
        Ok(())
    }

    /// Removes the access of others to files of iceoryx2: their writes could end every process.
    pub(crate) fn restrict_files(&self) {
        for path in self.shared_files() {
            let Ok(found) = path.symlink_metadata() else {
                continue;
            };
            if found.is_file() && found.mode() & 0o077 != 0 {
                // The file may be gone already.
                let _ = set_permissions(&path, Permissions::from_mode(0o600));
            }
        }
    }

    fn shared_files(&self) -> impl Iterator<Item = PathBuf> {
        let entries = read_dir(SHARED_MEMORY).into_iter().flatten().flatten();
        let is_ours = |entry: &DirEntry| {
            let name = entry.file_name();
            name.as_encoded_bytes().starts_with(self.prefix.as_bytes())
        };
        entries.filter(is_ours).map(|entry| entry.path())
    }

    pub(crate) fn files_of_node(&self, node: u128) -> Vec<PathBuf> {
        let folder = self.root.join("nodes").join(node.to_string());
        let entries = read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).collect()
    }

    /// Returns the configuration of every node; members that read host files would not meet.
    pub(crate) fn config(&self) -> Config {
        // Both are short and have only valid characters.
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

/// Returns the path of the socket on which the launcher of `graph` receives control requests.
pub fn control_socket(graph: &GraphName) -> PathBuf {
    let Membership { root, prefix, .. } = Membership::of(graph);
    root.join(format!("{prefix}{CONTROL}"))
}

/// True if a launcher is running `graph`.
pub fn is_launched(graph: &GraphName) -> bool {
    Claim::is_taken(graph)
}

/// Returns the graphs of this user that have a launcher, found by its socket.
pub fn running_graphs() -> Vec<GraphName> {
    let user = current_user();
    let entries = read_dir(path_for(user)).into_iter().flatten().flatten();
    let name = |entry: DirEntry| {
        let name = graph_of_file(&entry.path(), user, CONTROL)?;
        // The claim shows that the launcher lives; a socket may be left over.
        Claim::is_taken(&name).then_some(name)
    };
    let mut names: Vec<_> = entries.filter_map(name).collect();
    names.sort_by(|a, b| a.as_str().cmp(b.as_str()));
    names
}

/// Returns the graphs that other users run on this machine, with their user ids.
pub fn graphs_of_others() -> Vec<(u32, GraphName)> {
    let locks = LockedFiles::now();
    let entries = read_dir(SHARED_MEMORY).into_iter().flatten().flatten();
    let graphs = entries.filter_map(|entry| {
        let file = entry.metadata().ok()?;
        let graph = graph_of_file(&entry.path(), file.uid(), LAUNCHER)?;
        (file.uid() != current_user() && locks.hold(&file)).then_some((file.uid(), graph))
    });
    let mut graphs: Vec<_> = graphs.collect();
    graphs.sort_by(|a, b| (a.0, a.1.as_str()).cmp(&(b.0, b.1.as_str())));
    graphs
}

/// Returns the prefix of the graph's files with the user; no name has the dot that ends it.
fn prefix(user: u32, graph: &GraphName) -> String {
    format!("bc{user}_{graph}.")
}

/// Returns the graph of `user` whose prefix followed by `end` is the name of a file.
pub(crate) fn graph_of_file(path: &Path, user: u32, end: &str) -> Option<GraphName> {
    let (graph, rest) = path.file_name()?.to_str()?.split_once('.')?;
    let name = GraphName::new(graph.strip_prefix(&format!("bc{user}_"))?).ok()?;
    (rest == end).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::root;

    #[test]
    fn a_file_shows_its_graph() {
        let robot = GraphName::new("robot-7").unwrap();
        let path = PathBuf::from(format!("/dev/shm/{}alive", prefix(1000, &robot)));
        assert_eq!(graph_of_file(&path, 1000, "alive"), Some(robot));
        assert_eq!(graph_of_file(&path, 1000, "launcher"), None);
        assert_eq!(graph_of_file(&path, 100, "alive"), None, "another user's");
        let nameless = Path::new("/dev/shm/bc1000_");
        assert_eq!(graph_of_file(nameless, 1000, "alive"), None);
        let launched = |name: &str| graph_of_file(Path::new(name), 1000, LAUNCHER);
        let robot = GraphName::new("robot_7").unwrap();
        assert_eq!(launched("bc1000_robot_7.launcher"), Some(robot));
        for other in ["bc1000_robot.alive", "sem.x", "bcx_robot.launcher"] {
            assert_eq!(launched(other), None, "{other}");
        }
    }

    #[test]
    fn no_prefix_begins_another_one() {
        let name = |text| GraphName::new(text).unwrap();
        let prefixes = [(1, "a"), (1, "a_b"), (1, "ab"), (11, "a"), (1, "1_a")]
            .map(|(user, graph)| prefix(user, &name(graph)));
        for (i, one) in prefixes.iter().enumerate() {
            for (j, other) in prefixes.iter().enumerate() {
                assert!(i == j || !one.starts_with(other), "{one} {other}");
            }
        }
    }

    #[test]
    fn the_longest_socket_path_fits() {
        // The name of a socket's file is a 128-bit number in decimal.
        let graph = GraphName::new(&"x".repeat(GraphName::CAPACITY)).unwrap();
        let folder = Path::new("/").join("x".repeat(root::MAX_BYTES - 1));
        assert!(path_for(u32::MAX).as_os_str().len() <= root::MAX_BYTES);
        let file = format!("{}{}.event", prefix(u32::MAX, &graph), u128::MAX);
        let longest = folder.join(file);
        // `sun_path` has 108 bytes, the last of which is zero.
        assert!(longest.as_os_str().len() <= 107, "{}", longest.display());
    }
}
