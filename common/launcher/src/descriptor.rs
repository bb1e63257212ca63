//! Finds and reads the graph's descriptor, for `run` and `check`.

use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::wrong_use;
use dataflow::{Dataflow, DataflowError};

use crate::{installed, run::supervision::is_essential};

pub const DEFAULT_FILE: &str = "dataflow.yaml";

/// Message of a process without a current directory.
pub const NO_FOLDER: &str = "cannot find the current directory";

#[derive(Debug)]
pub struct Descriptor {
    pub dataflow: Dataflow,
    pub file: PathBuf,
    /// Absolute path of the folder of the descriptor; paths in the descriptor are relative to it.
    pub folder: PathBuf,
}

/// Handling of the build commands in a descriptor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Builds {
    Run,
    LeaveOut,
}

/// Reads and checks the descriptor `file`, or the installed one if [`DEFAULT_FILE`] is missing.
pub fn load(file: &Path, builds: Builds) -> anyhow::Result<Descriptor> {
    let is_default = file == Path::new(DEFAULT_FILE) && !file.exists();
    let installed = is_default.then(installed::demonstration).flatten();
    let file = installed.as_deref().unwrap_or(file);
    let absolute = std::path::absolute(file).context(NO_FOLDER)?;
    if !absolute.exists() {
        let (file, folder) = (file.display(), std::env::current_dir().context(NO_FOLDER)?);
        return Err(wrong_use(format!(
            "there is no file {file} in {}: run in a folder that has one, as the repository's root does, \
             or name it: `backcast run path/to/dataflow.yaml`",
            folder.display()
        )));
    }
    let mut dataflow = dataflow::load(file)?;
    // A file always has a parent; the fallback is never used.
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
    use command_line::exit_code;

    use super::*;

    #[test]
    fn wrong_wiring_and_missing_executables_are_failures() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("g.yaml");
        let check = |text: &str, expected: &str| {
            std::fs::write(&file, text).unwrap();
            let error = load(&file, Builds::LeaveOut).unwrap_err();
            assert_eq!(exit_code(&error), 1);
            let said = error.to_string();
            assert!(said.contains(expected), "{said}");
        };
        check(
            "nodes: [{id: a, path: /bin/sh, outputs: [scam]}]",
            "g.yaml:1:42: there is no topic",
        );
        check("nodes: [{id: a, path: nowhere}]", "g.yaml:1:23: `nowhere`");
        check(
            "nodes: [{id: a, path: nowhere, build: make}]",
            "g.yaml:1:23: `nowhere` does not exist, and nothing builds it",
        );
    }
}
