//! A graph that belongs to one test.

use std::path::{Path, PathBuf};

use crate::membership::SHARED_MEMORY;
use crate::root::{current_user, path_for};
use crate::{Graph, GraphName, remove_leftovers};

/// A graph whose name no other test and no other run uses; what it leaves is
/// removed in the end. To be declared before everything that is in the graph,
/// so that it is dropped last; in a struct, behind it.
#[derive(Debug)]
pub struct Isolated {
    name: GraphName,
}

impl Isolated {
    /// `tag` tells the tests of one executable apart, in at most 11 bytes.
    ///
    /// # Panics
    /// If `tag` is longer, or holds what a graph's name must not.
    #[must_use]
    pub fn new(tag: &str) -> Self {
        let name = GraphName::new(&format!("t{}-{tag}", std::process::id())).unwrap();
        Isolated { name }
    }

    /// The graph's name.
    #[must_use]
    pub fn name(&self) -> &GraphName {
        &self.name
    }

    /// The test's own membership, as `node`.
    ///
    /// # Panics
    /// If the test cannot join.
    #[must_use]
    pub fn join(&self, node: &str) -> Graph {
        Graph::join_named(node, &self.name).unwrap()
    }

    /// Every file of the graph, wherever it lies.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        for folder in [Path::new(SHARED_MEMORY), &path_for(current_user())] {
            collect(folder, &format!("_{}.", self.name), &mut found);
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
