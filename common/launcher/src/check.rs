//! `backcast check`: reports all errors in a descriptor and in its nodes' arguments, which they
//! check themselves, and prints the graph as text.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, ExitCode, Stdio};

use anyhow::{Context, bail};
use command_line::stdout;
use dataflow::{Dataflow, Node, RestartPolicy};
use transport::node::CHECK_ARGUMENTS_VARIABLE;

use crate::descriptor::{self, Builds, Descriptor};
use crate::installed::is_ours;
use crate::run::arguments::value;
use crate::run::{executable, lasers, not_started, shared};

/// Node that takes scans of a ROS 2 robot.
const GATEWAY: &str = "ros2_gateway";

#[derive(Debug, clap::Args)]
pub struct Config {
    /// The graph's descriptor
    #[arg(default_value = descriptor::DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,
}

/// Checks the descriptor and the arguments of its nodes, and prints the graph.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let Descriptor {
        dataflow,
        file,
        folder,
    } = descriptor::load(&config.dataflow, Builds::Run)?;
    // Only our nodes can end after checking their arguments.
    let (built, unbuilt): (Vec<&Node>, Vec<&Node>) = dataflow
        .nodes
        .iter()
        .filter(|node| is_ours(node))
        .partition(|node| executable(node, &folder).is_file());
    let mut refused: Vec<String> = built
        .iter()
        .filter_map(|node| refused_arguments(node, &folder).transpose())
        .collect::<Result<_, _>>()?;
    refused.extend(tildes(&dataflow));
    refused.extend(unset_mount(&dataflow));
    if refused.is_empty() {
        let mut named = dataflow.clone();
        let alike = lasers::name(&mut named, &folder).and_then(|()| shared::check(&named, &folder));
        refused.extend(alike.err().map(|error| format!("{error:#}")));
    }
    let picture = picture(&dataflow);
    if refused.is_empty() && !unbuilt.is_empty() {
        let ids: Vec<&str> = unbuilt.iter().map(|node| node.id.as_str()).collect();
        refused.push(format!(
            "not checked, as they are not built: arguments of {}; `backcast run` builds them",
            ids.join(", ")
        ));
        stdout::print(&picture)?;
    }
    if !refused.is_empty() {
        let refused = refused.join("\n");
        bail!("{}: {refused}", file.display());
    }
    stdout::print(&format!("{} is sound\n\n{picture}", file.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns a line for each argument with a `~` of our nodes but the gateway, where it is a name.
fn tildes(dataflow: &Dataflow) -> impl Iterator<Item = String> {
    let nodes = dataflow.nodes.iter();
    let nodes = nodes.filter(|node| is_ours(node) && node.executable() != GATEWAY);
    nodes.flat_map(|node| {
        let words = node.args.iter();
        let words = words.filter(|word| word.starts_with('~') || word.contains("=~"));
        words.map(|word| {
            let id = &node.id;
            format!("node {id}: {word}: no shell expands `~` here, write the whole path")
        })
    })
}

/// Returns a line if a mount is given, and each is that of an example: 0,0,0.
fn unset_mount(dataflow: &Dataflow) -> Option<String> {
    let nodes = dataflow.nodes.iter();
    let nodes = nodes.filter(|node| [lasers::LMS_READER, GATEWAY].contains(&node.executable()));
    let mut mounts = nodes.filter_map(|node| Some((&node.id, value(node, "--mount")?)));
    let is_zero = |text: &str| {
        let numbers = text.split(',').map(|number| number.trim().parse());
        numbers.collect::<Result<Vec<f64>, _>>().as_deref() == Ok(&[0.0; 3])
    };
    let (id, mount) = mounts.clone().next()?;
    mounts.all(|(_, mount)| is_zero(mount)).then(|| {
        format!(
            "node {id}: --mount {mount} looks as if it was never set: measure metres ahead, metres \
             to the left and degrees; a laser exactly on the base has {mount},0"
        )
    })
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

/// Returns a paragraph for each node: inputs with their senders, outputs with their receivers.
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
    let ids = dataflow.nodes.iter().filter(takes).map(|n| n.id.as_str());
    match &ids.collect::<Vec<_>>()[..] {
        [] => "(no node of this graph)".to_owned(),
        ids => ids.join(", "),
    }
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

    #[test]
    fn a_tilde_is_no_path_to_a_node_and_a_name_to_ros() {
        let text = "nodes:
  - {id: m, path: map_server, args: --map ~/map.yaml}
  - {id: r, path: bin/replayer, args: --recording=~/r.mcap --rate a~b}
  - {id: g, path: ros2_gateway, args: --scan ~/scan}
  - {id: x, path: /bin/sh, args: -c ~/run}
";
        let said: Vec<String> = tildes(&parsed(text)).collect();
        let expected = [
            "node m: ~/map.yaml: no shell",
            "node r: --recording=~/r.mcap: no",
        ];
        assert_eq!(said.len(), expected.len(), "{said:?}");
        for (said, expected) in said.iter().zip(expected) {
            assert!(said.starts_with(expected), "{said}");
        }
    }

    #[test]
    fn a_mount_of_zeros_is_doubted_unless_it_is_meant() {
        let said = |lasers: &[&str]| {
            let node = |(n, mount)| format!("{{id: n{n}, path: lms_reader, args: \"{mount}\"}}");
            let nodes: Vec<String> = lasers.iter().enumerate().map(node).collect();
            unset_mount(&parsed(&format!("nodes: [{}]", nodes.join(", "))))
        };
        for set in [&["--tcp a"][..], &["--mount 0,0,0,0"], &["--mount 0,0,90"]] {
            assert_eq!(said(set), None, "{set:?}");
        }
        assert_eq!(said(&["--mount=0,0,0", "--mount 0.5,0,180"]), None);
        let zeros = said(&["--mount 0.0,0,-0"]).unwrap();
        assert!(zeros.contains("has 0.0,0,-0,0"), "{zeros}");
    }
}
