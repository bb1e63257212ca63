//! `backcast check`: reports all errors in a descriptor and in its nodes' arguments, and prints the
//! graph as text. It builds and changes nothing; nodes are started only to check their arguments.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::{Command as Process, ExitCode, Stdio},
};

use anyhow::{Context, bail};
use command_line::stdout;
use dataflow::{Dataflow, Node, RestartPolicy};
use transport::node::CHECK_ARGUMENTS_VARIABLE;

use crate::{
    descriptor::{self, Builds},
    installed::is_ours,
    run::{executable, not_started},
};

#[derive(Debug, clap::Args)]
pub struct Config {
    /// The graph's descriptor
    #[arg(default_value = descriptor::DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,
}

/// Checks the descriptor and prints the graph.
///
/// # Errors
/// The descriptor is missing or wrong, or a node rejects its arguments.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let descriptor = descriptor::load(&config.dataflow, Builds::Run)?;
    let nodes = descriptor.dataflow.nodes.iter();
    // Only our nodes can end after checking their arguments.
    let (built, unbuilt): (Vec<&Node>, Vec<&Node>) = nodes
        .filter(|node| is_ours(node))
        .partition(|node| executable(node, &descriptor.folder).is_file());
    let refused: Vec<String> = built
        .iter()
        .filter_map(|node| refused_arguments(node, &descriptor.folder).transpose())
        .collect::<Result<_, _>>()?;
    if !refused.is_empty() {
        bail!("{}: {}", descriptor.file.display(), refused.join("\n"));
    }
    let picture = picture(&descriptor.dataflow);
    let mut text = format!("{} is sound\n", descriptor.file.display());
    if !unbuilt.is_empty() {
        let ids: Vec<&str> = unbuilt.iter().map(|node| node.id.as_str()).collect();
        let ids = ids.join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "not checked, as they are not built: arguments of {ids}"
        );
    }
    stdout::print(&format!("{text}\n{picture}"))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the node's error message if it rejects its arguments.
fn refused_arguments(node: &Node, folder: &Path) -> anyhow::Result<Option<String>> {
    let output = Process::new(executable(node, folder))
        .args(&node.args)
        .envs(node.env.iter().map(|(name, value)| (name, value)))
        .env(CHECK_ARGUMENTS_VARIABLE, "1")
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .with_context(|| not_started(node, folder))?;
    let said = String::from_utf8_lossy(&output.stderr);
    // The first paragraph is the error, the rest is usage.
    let reason = said.split("\n\n").next().unwrap_or_default();
    let reason = reason.trim().trim_start_matches("error: ");
    let refused = (!output.status.success()).then(|| format!("node {}: {reason}", node.id));
    Ok(refused)
}

/// Returns a paragraph for each node: its inputs with their senders, its outputs with their
/// receivers.
fn picture(dataflow: &Dataflow) -> String {
    let mut text = String::new();
    for node in &dataflow.nodes {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{} ({}{})", node.id, node.path, restarts(node));
        for input in &node.inputs {
            let _ = writeln!(text, "    <- {:<14} {}", input.topic, input.from);
        }
        for topic in &node.outputs {
            let _ = writeln!(text, "    -> {topic:<14} {}", receivers(dataflow, topic));
        }
    }
    text
}

fn restarts(node: &Node) -> String {
    let limit = match node.restart.max_restarts {
        0 => String::new(),
        n => format!(" up to {n} times"),
    };
    match node.restart.policy {
        RestartPolicy::Never => String::new(),
        RestartPolicy::OnFailure => format!(", restarted on failure{limit}"),
        RestartPolicy::Always => format!(", always restarted{limit}"),
    }
}

fn receivers(dataflow: &Dataflow, topic: &str) -> String {
    let takes = |n: &&Node| n.inputs.iter().any(|i| i.topic == topic);
    let ids: Vec<&str> = dataflow
        .nodes
        .iter()
        .filter(takes)
        .map(|n| n.id.as_str())
        .collect();
    if ids.is_empty() {
        return "(no node of this graph)".to_owned();
    }
    ids.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    #[test]
    fn the_picture_shows_wires_from_both_ends() {
        let text = "nodes:
  - {id: a, path: x, outputs: [scan]}
  - {id: b, path: y, inputs: {scan: a/scan}, outputs: [votes], restart_policy: on-failure, max_restarts: 3}
";
        assert_eq!(
            picture(&parsed(text)),
            "a (x)
    -> scan           b
b (y, restarted on failure up to 3 times)
    <- scan           a
    -> votes          (no node of this graph)
"
        );
    }
}
