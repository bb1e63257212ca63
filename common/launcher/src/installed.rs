//! Where an installation keeps what belongs to the command: nodes in `../lib/backcast`, the
//! demonstration in `../share/backcast`, seen from the folder of the command.
//!
//! In a target folder, the nodes lie beside the command.

use std::env;
use std::path::{Path, PathBuf};

use dataflow::Node;

/// The executables of our nodes.
const NODES: [&str; 15] = [
    "accumulator",
    "boundary_extractor",
    "bridge",
    "emulator",
    "fleet_monitor",
    "foxglove_server",
    "lms_reader",
    "locate_server",
    "map_server",
    "monitor",
    "peak_extractor",
    "recorder",
    "replayer",
    "ros2_gateway",
    "tracker",
];

/// Whether a node runs one of our programs, by its name.
pub(crate) fn is_ours(node: &Node) -> bool {
    NODES.contains(&node.executable())
}

/// The descriptor of the demonstration, if there is one.
pub(crate) fn demonstration() -> Option<PathBuf> {
    let file = prefix()?.join("share/backcast/dataflow.yaml");
    file.is_file().then_some(file)
}

/// Where the executable of a bare name is, absolute: not in `folder`, where a path of the
/// descriptor begins, but beside the command, in the installation's folder of nodes, or on
/// the `PATH`, where dora looks too. None for every other path.
pub(crate) fn find(path: &str, folder: &Path) -> Option<String> {
    if path.contains('/') || folder.join(path).exists() {
        return None;
    }
    let found = folders().map(|folder| folder.join(path));
    let mut found = found.filter(|path| path.is_absolute() && path.is_file());
    found.next()?.into_os_string().into_string().ok()
}

/// The executable of a node, by its name, beside the command or where it is installed.
pub fn node(name: &str) -> Option<PathBuf> {
    find(name, Path::new("/")).map(PathBuf::from)
}

/// Where a bare name is looked for.
fn folders() -> impl Iterator<Item = PathBuf> {
    let nodes = prefix().map(|prefix| prefix.join("lib/backcast"));
    let own = command().and_then(|command| command.parent().map(Path::to_owned));
    let path = env::var_os("PATH").unwrap_or_default();
    let path: Vec<PathBuf> = env::split_paths(&path).collect();
    own.into_iter().chain(nodes).chain(path)
}

fn prefix() -> Option<PathBuf> {
    Some(command()?.parent()?.parent()?.to_owned())
}

/// The command, links followed.
fn command() -> Option<PathBuf> {
    env::current_exe().ok()?.canonicalize().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_nodes_of_this_repository_are_known() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../nodes");
        let nodes = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = nodes.map(|node| node.unwrap().file_name()).collect();
        names.retain(|name| name != "backcast");
        names.sort();
        assert_eq!(names, NODES);
    }

    #[test]
    fn a_bare_name_is_found_beside_the_command_and_on_the_path() {
        let folder = tempfile::tempdir().unwrap();
        let command = command().unwrap();
        let own = command.file_name().unwrap().to_str().unwrap();
        assert_eq!(
            find(own, folder.path()),
            command.to_str().map(str::to_owned)
        );
        assert!(find("sh", folder.path()).unwrap().ends_with("/sh"));
        // What the descriptor's folder has, a path, and what is nowhere stay as they are.
        std::fs::write(folder.path().join("sh"), "").unwrap();
        for path in ["sh", "./sh", "/bin/sh", "no-such-executable"] {
            assert_eq!(find(path, folder.path()), None, "{path}");
        }
    }
}
