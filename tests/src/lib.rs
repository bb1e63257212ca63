//! Code that the tests of whole graphs share: the executables, the recordings, and the results of a
//! graph.
#![allow(clippy::unwrap_used, reason = "this crate is tests and nothing else")]

pub mod answers;
pub mod axe;
pub mod browser;
pub mod building;
pub mod drawn_map;
pub mod executables;
pub mod help;
pub mod http;
pub mod live;
pub mod machine;
pub mod markdown;
pub mod needs;
pub mod network;
pub mod python;
pub mod recorded;
pub mod robot;
pub mod world;

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

/// Returns the folder of recordings of other robots, if there is one.
#[must_use]
pub fn evaluation_data() -> Option<PathBuf> {
    beside_the_project("shared/data/evaluation")
}

/// Returns the folder of faulty recordings of users, if there is one.
#[must_use]
pub fn broken_recordings() -> Option<PathBuf> {
    beside_the_project("shared/cases")
}

/// Finds a folder next to the project, or next to a folder that contains it.
fn beside_the_project(name: &str) -> Option<PathBuf> {
    let folders = root().canonicalize().unwrap();
    let mut candidates = folders.ancestors().map(|f| f.join(name));
    candidates.find(|folder| folder.is_dir())
}

/// Runs a command that must succeed, and returns its output as JSON.
#[must_use]
pub fn json_of(command: &mut Command) -> Value {
    let output = command.output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Returns the root of the repository.
#[must_use]
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}
