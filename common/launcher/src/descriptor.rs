//! Finding and reading the graph's descriptor, as `run` and `check` both do.

use std::path::{Path, PathBuf};

use dataflow::{Dataflow, DataflowError, Topics};
use messages::{Topic, topic};

use crate::{LauncherError, installed, run::supervision::is_essential};

/// Where the descriptor is looked for.
pub const DEFAULT_FILE: &str = "dataflow.yaml";

/// The ports that a descriptor may use. Every node sends its health and its log.
const TOPICS: Topics = Topics {
    names: topic::NAMES,
    shared: &[topic::Health::NAME, topic::Log::NAME],
    several: &[topic::Scan::NAME],
};

/// A descriptor and its folder.
#[derive(Debug)]
pub struct Descriptor {
    /// The graph.
    pub dataflow: Dataflow,
    /// As it was given.
    pub file: PathBuf,
    /// Where it lies; absolute. Paths in it begin here.
    pub folder: PathBuf,
}

/// What is done with the build commands of a descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Builds {
    /// They are run.
    Run,
    /// They are left out: the executables must be there.
    LeaveOut,
}

/// Reads and checks the descriptor `file`, and that its executables exist or
/// are built. Without a [`DEFAULT_FILE`] here, that of the installation is meant.
///
/// # Errors
/// It is not there, or wrong.
pub fn load(file: &Path, builds: Builds) -> Result<Descriptor, LauncherError> {
    let is_default = file == Path::new(DEFAULT_FILE) && !file.exists();
    let installed = is_default.then(installed::demonstration).flatten();
    let file = installed.as_deref().unwrap_or(file);
    let absolute = std::path::absolute(file).map_err(LauncherError::Folder)?;
    if !absolute.exists() {
        return Err(LauncherError::NoDescriptor {
            file: file.to_owned(),
            folder: std::env::current_dir().map_err(LauncherError::Folder)?,
        });
    }
    let mut dataflow = dataflow::load(file, &TOPICS)?;
    // A file has a folder; the root of the file system is none.
    let folder = absolute.parent().unwrap_or(Path::new("/")).to_owned();
    for node in &mut dataflow.nodes {
        is_essential(node)?;
        if builds == Builds::LeaveOut {
            node.build.clear();
        }
        if let Some(path) = installed::find(&node.path, &folder) {
            node.path = path;
        }
    }
    let problems = dataflow::check_executables(&dataflow, &folder);
    let file = file.to_owned();
    if !problems.is_empty() {
        return Err(DataflowError::Wrong { file, problems }.into());
    }
    Ok(Descriptor {
        dataflow,
        file,
        folder,
    })
}

#[cfg(test)]
mod tests {
    use command_line::CommandError;

    use super::*;

    #[test]
    fn the_descriptor_of_the_repository_is_sound() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../dataflow.yaml");
        let descriptor = load(Path::new(file), Builds::Run).unwrap();
        let ids: Vec<_> = descriptor.dataflow.nodes.iter().map(|n| &*n.id).collect();
        assert!(ids.contains(&"accumulator"), "{ids:?}");
        assert!(descriptor.folder.join("Cargo.toml").exists());
    }

    #[test]
    fn a_missing_descriptor_says_what_to_do() {
        let error = load(Path::new("no/such.yaml"), Builds::Run).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let said = error.to_string();
        assert!(
            said.contains("no/such.yaml") && said.contains("backcast run path"),
            "{said}"
        );
    }

    #[test]
    fn wrong_wiring_and_missing_executables_are_failures() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("g.yaml");
        let check = |text: &str, expected: &str| {
            std::fs::write(&file, text).unwrap();
            let error = load(&file, Builds::LeaveOut).unwrap_err();
            assert_eq!(error.exit_code(), 1);
            let said = error.to_string();
            assert!(said.contains(expected), "{said}");
        };
        check(
            "nodes: [{id: a, path: /bin/sh, outputs: [scam]}]",
            "g.yaml:1:42: there is no topic",
        );
        check(
            "nodes: [{id: a, path: nowhere}]",
            "g.yaml:1:23: `nowhere` does not exist, and nothing builds it",
        );
        check(
            "nodes: [{id: a, path: nowhere, build: make}]",
            "g.yaml:1:23: `nowhere` does not exist, and nothing builds it",
        );
    }
}
