//! Code that the tests of whole graphs share: the executables, the recordings, and the results of a
//! graph.
#![allow(clippy::unwrap_used, reason = "this crate is tests and nothing else")]

pub mod answers;
pub mod axe;
pub mod browser;
pub mod building;
pub mod drawn_map;
pub mod drawn_room;
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
pub mod schemas;
pub mod world;

use std::fs::File;
use std::path::PathBuf;
use std::process::{Child, Command};

use serde_json::Value;

use crate::needs::Need;

/// Returns the folder of recordings of other robots; `None` if it is missing, which is reported for
/// this test.
pub fn evaluation_data(test: &str) -> Option<PathBuf> {
    beside_the_project(test, "shared/data/evaluation")
}

/// Returns the folder of faulty recordings of users; `None` if it is missing, which is reported for
/// this test.
pub fn broken_recordings(test: &str) -> Option<PathBuf> {
    beside_the_project(test, "shared/cases")
}

/// Finds a folder next to the project, or next to a folder that contains it.
fn beside_the_project(test: &str, name: &str) -> Option<PathBuf> {
    let folders = root().canonicalize().unwrap();
    let mut candidates = folders.ancestors().map(|f| f.join(name));
    let found = candidates.find(|folder| folder.is_dir());
    if found.is_none() {
        Need::Data.is_missing(test, &format!("no folder {name} beside the project"));
    }
    found
}

/// Runs a command to its end; returns exit code, standard output and standard error.
pub fn said_by(command: &mut Command) -> (i32, String, String) {
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let code = output.status.code().unwrap();
    (code, text(output.stdout), text(output.stderr))
}

/// Asserts the exit code of a command and a part of its standard error.
#[track_caller]
pub fn assert_ends((code, _, stderr): (i32, String, String), expected: i32, part: &str) {
    let is_expected = code == expected && stderr.contains(part);
    assert!(is_expected, "{part}: {code}: {stderr}");
}

/// Runs a command that must succeed, and returns its output.
pub fn text_of(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs a command that must succeed, and returns its output as JSON.
pub fn json_of(command: &mut Command) -> Value {
    serde_json::from_str(&text_of(command)).unwrap()
}

/// Runs a command that must succeed, and returns each line of its output as JSON.
pub fn json_lines_of(command: &mut Command) -> Vec<Value> {
    let text = text_of(command);
    let rows = text.lines().map(|line| serde_json::from_str(line).unwrap());
    rows.collect()
}

/// Runs a command; the error says what it was and what it printed.
fn attempt(command: &mut Command) -> Result<(), String> {
    let outcome = command.output();
    let outcome = outcome.map_err(|error| format!("{command:?}: {error}"))?;
    if outcome.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&outcome.stderr);
    Err(format!("{command:?}: {}\n{said}", outcome.status))
}

/// Locks a folder in the target folder until the file is dropped: concurrent tests wait for the one
/// that fills it.
fn locked_folder(name: &str) -> (PathBuf, File) {
    let folder = executables::target().join(name);
    let lock = File::create(folder.with_extension("lock")).unwrap();
    lock.lock().unwrap();
    (folder, lock)
}

/// A process that is killed when this is dropped, if it still runs.
struct Killed(Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_owned()
}
