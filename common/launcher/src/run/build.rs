//! Runs the build commands of the descriptor, each once.

use std::{
    collections::HashSet,
    io,
    os::fd::AsFd,
    path::Path,
    process::{Command as Process, Stdio},
};

use dataflow::{Dataflow, Node};

use super::{console::note, process::executable};
use crate::LauncherError;

/// Builds every node, in the order of the descriptor and in its `folder`. Two nodes with the same
/// commands and environment are built once. Output of the builds goes to our standard error. If the
/// build program is not installed, existing executables are used as they are.
///
/// # Errors
/// A command cannot be started or failed.
pub fn build_all(dataflow: &Dataflow, folder: &Path) -> Result<(), LauncherError> {
    let with_build = || dataflow.nodes.iter().filter(|n| !n.build.is_empty());
    let ids: Vec<&str> = with_build().map(|n| n.id.as_str()).collect();
    if !ids.is_empty() {
        note(&format!("building {}", ids.join(", ")));
    }
    let mut built = HashSet::new();
    for node in with_build().filter(|n| built.insert((&n.build, &n.env))) {
        match build(node, folder) {
            Err(LauncherError::BuildNotStarted {
                command, source, ..
            }) if source.kind() == io::ErrorKind::NotFound => {
                let missing = missing(with_build().filter(|n| n.build == node.build), folder);
                if !missing.is_empty() {
                    let program = command.split(' ').next().unwrap_or_default().to_owned();
                    return Err(LauncherError::NothingToRun {
                        program,
                        command,
                        missing: missing.join(", "),
                    });
                }
                note(&format!(
                    "`{command}` cannot be started: the nodes are run as they are"
                ));
            }
            outcome => outcome?,
        }
    }
    Ok(())
}

/// Returns the ids of the nodes without an executable.
fn missing<'a>(nodes: impl Iterator<Item = &'a Node>, folder: &Path) -> Vec<&'a str> {
    let without = nodes.filter(|node| !executable(node, folder).is_file());
    without.map(|node| node.id.as_str()).collect()
}

fn build(node: &Node, folder: &Path) -> Result<(), LauncherError> {
    for command in &node.build {
        let not_started = |source| LauncherError::BuildNotStarted {
            node: node.id.clone(),
            command: command.to_string(),
            source,
        };
        let status = Process::new(&command.program)
            .args(&command.args)
            .envs(node.env.iter().map(|(name, value)| (name, value)))
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(stderr().map_err(not_started)?)
            .status()
            .map_err(not_started)?;
        if !status.success() {
            return Err(LauncherError::BuildFailed {
                node: node.id.clone(),
                command: command.to_string(),
                status,
            });
        }
    }
    Ok(())
}

fn stderr() -> io::Result<Stdio> {
    io::stderr().as_fd().try_clone_to_owned().map(Stdio::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build_nodes(nodes: &str, folder: &Path) -> Result<(), LauncherError> {
        let text = format!("nodes:\n{nodes}");
        let dataflow = dataflow::parse(&text, &dataflow::Topics::default()).unwrap();
        build_all(&dataflow, folder)
    }

    #[test]
    fn equal_builds_run_once_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("log.sh"), "echo $1 $TAG >> log\n").unwrap();
        let nodes = "
  - {id: a, path: x, build: sh log.sh one}
  - {id: b, path: x, build: sh log.sh one}
  - {id: c, path: x, build: sh log.sh one, env: {TAG: tagged}}
  - id: d
    path: x
    build: |
      sh log.sh two
      sh log.sh three
";
        build_nodes(nodes, folder.path()).unwrap();
        let log = std::fs::read_to_string(folder.path().join("log")).unwrap();
        assert_eq!(log, "one\none tagged\ntwo\nthree\n");
    }

    #[test]
    fn a_failed_build_is_named_and_ends_it() {
        let folder = tempfile::tempdir().unwrap();
        let nodes =
            "  - {id: a, path: x, build: false}\n  - {id: b, path: x, build: touch built}\n";
        let said = build_nodes(nodes, folder.path()).unwrap_err().to_string();
        assert_eq!(said, "node a: the build `false` failed with exit status: 1");
        assert!(!folder.path().join("built").exists());
        let nodes = "  - {id: a, path: x, build: no-such-program x}\n";
        let said = build_nodes(nodes, folder.path()).unwrap_err().to_string();
        let expected = "no-such-program is not installed, and there are no executables of a: ";
        assert!(said.starts_with(expected), "{said}");
        assert!(said.contains("docs/install.md"), "{said}");
    }

    #[test]
    fn what_was_built_elsewhere_needs_no_program_that_builds() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("x"), "").unwrap();
        let node = |id, path| format!("  - {{id: {id}, path: {path}, build: no-such-program}}\n");
        let built = node("a", "x") + "  - {id: b, path: y, build: touch built}\n";
        build_nodes(&built, folder.path()).unwrap();
        assert!(folder.path().join("built").exists());
        let in_part = node("a", "x") + &node("b", "z");
        let said = build_nodes(&in_part, folder.path()).unwrap_err();
        assert!(said.to_string().contains("executables of b: "), "{said}");
    }
}
