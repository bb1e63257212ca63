//! Runs the build commands of the descriptor, each once.

use std::collections::HashSet;
use std::io;
use std::os::fd::AsFd;
use std::path::Path;
use std::process::{Command as Process, Stdio};

use anyhow::{Context, bail};
use dataflow::{Command, Dataflow, Node};

use super::{console::note, process::executable};

/// Builds every node in the descriptor's `folder`, the same command once. If the build program is
/// not installed, existing executables are used as they are.
pub fn build_all(dataflow: &Dataflow, folder: &Path) -> anyhow::Result<()> {
    let with_build = || dataflow.nodes.iter().filter(|n| !n.build.is_empty());
    let ids: Vec<&str> = with_build().map(|n| n.id.as_str()).collect();
    if !ids.is_empty() {
        note(&format!("building {}", ids.join(", ")));
    }
    let mut built = HashSet::new();
    for node in with_build().filter(|n| built.insert((&n.build, &n.env))) {
        let Some(command) = build(node, folder)? else {
            continue;
        };
        let missing = missing(with_build().filter(|n| n.build == node.build), folder).join(", ");
        if !missing.is_empty() {
            let program = &command.program;
            bail!(
                "{program} is not installed, and there are no executables of {missing}: install what \
                 `{command}` needs (Rust: https://rustup.rs), or get the nodes built, as a package or by \
                 packaging/install elsewhere (docs/install.md), and name them in the descriptor without a folder"
            );
        }
        note(&format!(
            "`{command}` cannot be started: the nodes are run as they are"
        ));
    }
    Ok(())
}

fn missing<'a>(nodes: impl Iterator<Item = &'a Node>, folder: &Path) -> Vec<&'a str> {
    let without = nodes.filter(|node| !executable(node, folder).is_file());
    without.map(|node| node.id.as_str()).collect()
}

/// Builds a node up to the first command whose program is not installed, which is returned.
fn build<'n>(node: &'n Node, folder: &Path) -> anyhow::Result<Option<&'n Command>> {
    let id = &node.id;
    for command in &node.build {
        let not_started = || {
            format!(
                "node {id}: the build `{command}` cannot be started; where all executables are \
                 there, --no-build runs them as they are"
            )
        };
        let status = Process::new(&command.program)
            .args(&command.args)
            .envs(node.env.iter().map(|(name, value)| (name, value)))
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(stderr().with_context(not_started)?)
            .status();
        let status = match status {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Some(command)),
            status => status.with_context(not_started)?,
        };
        if !status.success() {
            bail!("node {id}: the build `{command}` failed with {status}");
        }
    }
    Ok(None)
}

fn stderr() -> io::Result<Stdio> {
    io::stderr().as_fd().try_clone_to_owned().map(Stdio::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build_nodes(nodes: &str, folder: &Path) -> anyhow::Result<()> {
        let text = format!("nodes:\n{nodes}");
        let dataflow = dataflow::parse(&text).unwrap();
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
