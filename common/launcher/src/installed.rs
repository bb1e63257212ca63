//! Paths of an installation, relative to the folder of the command.

use std::env;
use std::path::{Path, PathBuf};

use dataflow::Node;

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

pub(crate) fn is_ours(node: &Node) -> bool {
    NODES.contains(&node.executable())
}

pub(crate) fn demonstration() -> Option<PathBuf> {
    let file = prefix()?.join("share/backcast/dataflow.yaml");
    file.is_file().then_some(file)
}

/// Returns the executable with a bare name, next to the command, among the installed nodes or on
/// the `PATH`; `None` for a path, or a file in `folder`.
pub(crate) fn find(path: &str, folder: &Path) -> Option<String> {
    if path.contains('/') || folder.join(path).exists() {
        return None;
    }
    let found = folders().map(|folder| folder.join(path));
    let mut found = found.filter(|path| path.is_absolute() && path.is_file());
    found.next()?.into_os_string().into_string().ok()
}

/// Returns the executable of the node `name`, next to the command or where it is installed.
pub fn node(name: &str) -> Option<PathBuf> {
    find(name, Path::new("/")).map(PathBuf::from)
}

/// Folders in which a bare name is searched, in this order.
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
        // These stay unchanged: a file in the descriptor's folder, paths, and unknown names.
        std::fs::write(folder.path().join("sh"), "").unwrap();
        for path in ["sh", "./sh", "/bin/sh", "no-such-executable"] {
            assert_eq!(find(path, folder.path()), None, "{path}");
        }
    }
}
