//! A graph of a single test.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::Sender;

use super::watch::watch;
use crate::membership::SHARED_MEMORY;
use crate::root::{current_user, path_for};
use crate::{Graph, GraphName, remove_leftovers};

/// A graph with a unique name, whose files are removed when this is dropped, so declare it before
/// everything in the graph; in a struct, as the last field.
#[derive(Debug)]
pub struct Isolated {
    name: GraphName,
    _watched: Option<Sender<()>>,
}

impl Isolated {
    /// Creates the graph. `tag` marks its name in lists of processes, with at most 11 bytes.
    #[must_use]
    pub fn new(tag: &str) -> Self {
        let name = name(tag);
        let _watched = Some(watch(name.clone()));
        Isolated { name, _watched }
    }

    /// Creates a graph without a time limit, for a benchmark.
    #[must_use]
    pub fn for_long(tag: &str) -> Self {
        Isolated {
            name: name(tag),
            _watched: None,
        }
    }

    pub fn name(&self) -> &GraphName {
        &self.name
    }

    #[must_use]
    pub fn join(&self, node: &str) -> Graph {
        Graph::join_named(node, &self.name).unwrap()
    }

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
    // The name has 20 bytes, 5 of them for the process id, whose maximum has 5 digits in base 36.
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
    // Other tests may remove their files and folders meanwhile.
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
