//! A graph that belongs to one test.

use std::path::{Path, PathBuf};

use transport::{GraphName, remove_leftovers};

/// A name that no other test and no other run uses; what the graph leaves is
/// removed in the end. To be declared first, so that it is dropped last.
pub(crate) struct Isolated {
    pub(crate) name: GraphName,
}

impl Isolated {
    /// `tag` tells the tests of one executable apart, in at most 11 bytes.
    pub(crate) fn new(tag: &str) -> Self {
        let name = GraphName::new(&format!("t{}-{tag}", std::process::id())).unwrap();
        Isolated { name }
    }

    /// Every file of the graph, wherever it lies.
    #[allow(dead_code, reason = "not every test executable looks for files")]
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let user = nix::unistd::geteuid();
        let mut found = Vec::new();
        for folder in ["/dev/shm", &format!("/tmp/backcast-{user}")] {
            collect(Path::new(folder), &format!("_{}.", self.name), &mut found);
        }
        found
    }
}

impl Drop for Isolated {
    fn drop(&mut self) {
        let outcome = remove_leftovers(&self.name);
        if !std::thread::panicking() {
            outcome.unwrap();
        }
    }
}

#[allow(dead_code, reason = "not every test executable looks for files")]
fn collect(folder: &Path, part: &str, found: &mut Vec<PathBuf>) {
    // Other tests remove files and folders of theirs meanwhile.
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        if path.is_dir() {
            collect(&path, part, found);
        } else if path.to_string_lossy().contains(part) {
            found.push(path);
        }
    }
}
