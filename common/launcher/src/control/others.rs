//! Graphs that other users of the machine run.
//!
//! Their files are closed to us, but names are seen by all, and so is in `/proc/locks` which of
//! them a process holds.

use std::fs::{self, Metadata};
use std::os::unix::fs::MetadataExt;

use nix::unistd::{Uid, User};

/// Where launchers hold a file each, called after user and graph.
const SHARED_MEMORY: &str = "/dev/shm";

/// Sentences on the graphs that other users run, and how they are reached.
pub(super) fn sentences() -> Vec<String> {
    let locks = fs::read_to_string("/proc/locks").unwrap_or_default();
    let entries = fs::read_dir(SHARED_MEMORY).into_iter().flatten().flatten();
    let graphs = entries.filter_map(|entry| {
        let (user, graph) = launched(entry.file_name().to_str()?)?;
        let found = fs::symlink_metadata(entry.path()).ok()?;
        let is_other = user != nix::unistd::geteuid().as_raw() && found.uid() == user;
        (is_other && is_held(&locks, &found)).then_some((user, graph))
    });
    let mut graphs: Vec<_> = graphs.collect();
    graphs.sort_unstable();
    let sentence = |(user, graph): (u32, String)| {
        let name = User::from_uid(Uid::from_raw(user)).ok().flatten();
        let name = name.map_or_else(|| format!("#{user}"), |user| user.name);
        format!("user {name} runs graph {graph}: `sudo -u {name} backcast status`")
    };
    graphs.into_iter().map(sentence).collect()
}

/// The user and the graph of a launcher's file, by its name.
fn launched(name: &str) -> Option<(u32, String)> {
    let name = name.strip_prefix("bc")?.strip_suffix(".launcher")?;
    let (user, graph) = name.split_once('_')?;
    Some((user.parse().ok()?, graph.to_owned()))
}

/// Whether a process holds a lock on a file, by the lines of `/proc/locks`: number, kind, mode,
/// access, process, `major:minor:inode`, and the range.
fn is_held(locks: &str, file: &Metadata) -> bool {
    let ends = format!(":{}", file.ino());
    locks.lines().any(|line| {
        let mut words = line.split_whitespace();
        words.nth(1) == Some("FLOCK") && words.nth(3).is_some_and(|at| at.ends_with(&ends))
    })
}

#[cfg(test)]
mod tests {
    use nix::fcntl::{Flock, FlockArg};

    use super::*;

    #[test]
    fn a_launchers_file_says_whose_graph_it_is() {
        assert_eq!(
            launched("bc1000_robot_7.launcher"),
            Some((1000, "robot_7".into()))
        );
        for other in ["bc1000_robot.alive", "sem.x", "bcx_robot.launcher"] {
            assert_eq!(launched(other), None, "{other}");
        }
    }

    #[test]
    fn a_lock_is_seen_while_it_is_held() {
        let file = tempfile::tempfile().unwrap();
        let found = file.metadata().unwrap();
        let locks = || fs::read_to_string("/proc/locks").unwrap();
        assert!(!is_held(&locks(), &found));
        let lock = Flock::lock(file, FlockArg::LockExclusive).unwrap();
        assert!(is_held(&locks(), &found));
        drop(lock);
    }
}
