//! A graph that belongs to one test.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::Sender;

use super::watch::watch;
use crate::membership::SHARED_MEMORY;
use crate::root::{current_user, path_for};
use crate::{Graph, GraphName, remove_leftovers};

/// A graph whose name no other one has, in this process or another; what it leaves is
/// removed in the end. A test that hangs is ended. To be declared before everything that is in
/// the graph, so that it is dropped last; in a struct, behind it.
#[derive(Debug)]
pub struct Isolated {
    name: GraphName,
    /// Closed in the end, which is what the watch waits for.
    _watched: Option<Sender<()>>,
}

impl Isolated {
    /// `tag` says in lists of processes whose graph it is, in at most 11 bytes.
    ///
    /// # Panics
    /// If `tag` is longer, or holds what a graph's name must not.
    #[must_use]
    pub fn new(tag: &str) -> Self {
        let name = name(tag);
        let _watched = Some(watch(name.clone()));
        Isolated { name, _watched }
    }

    /// For a benchmark, which takes as long as requested.
    ///
    /// # Panics
    /// As [`Isolated::new`].
    #[must_use]
    pub fn for_long(tag: &str) -> Self {
        Isolated {
            name: name(tag),
            _watched: None,
        }
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

fn name(tag: &str) -> GraphName {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    // Of 20 bytes 5 are left for the process, as many as its largest number has in base 36.
    let [process, count] = [std::process::id(), count].map(in_base_36);
    GraphName::new(&format!("{process}-{count}-{tag}")).unwrap()
}

fn in_base_36(mut number: u32) -> String {
    let mut digits = Vec::new();
    loop {
        digits.push(char::from_digit(number % 36, 36).unwrap());
        number /= 36;
        if number == 0 {
            return digits.iter().rev().collect();
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graphs_of_the_same_tag_have_names_of_their_own() {
        let [first, second] = [0, 1].map(|_| name("eleven-long"));
        assert_ne!(first, second);
        assert_eq!(in_base_36(4_194_304), "2hwcg");
    }
}
