//! `backcast check`: all that is wrong with a descriptor, or a picture of the
//! graph. It builds, starts and changes nothing.

use std::{fmt::Write as _, path::PathBuf, process::ExitCode};

use command_line::stdout;
use dataflow::{Dataflow, Node, RestartPolicy};

use crate::{LauncherError, descriptor};

/// Options of `backcast check`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The graph's descriptor
    #[arg(default_value = descriptor::DEFAULT_FILE, value_name = "FILE")]
    dataflow: PathBuf,
}

/// Prints the picture.
///
/// # Errors
/// The descriptor is missing or wrong.
pub fn run(config: &Config) -> Result<ExitCode, LauncherError> {
    let descriptor = descriptor::load(&config.dataflow)?;
    let picture = picture(&descriptor.dataflow);
    stdout::print(&format!(
        "{} is sound\n\n{picture}",
        descriptor.file.display()
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// A paragraph for each node: what it takes and sends, and to whom.
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
    use dataflow::{Topics, parse};

    #[test]
    fn the_picture_shows_wires_from_both_ends() {
        let topics = Topics {
            names: &["scan", "votes"],
            shared: &[],
            several: &[],
        };
        let text = "nodes:
  - {id: a, path: x, outputs: [scan]}
  - {id: b, path: y, inputs: {scan: a/scan}, outputs: [votes], restart_policy: on-failure, max_restarts: 3}
";
        assert_eq!(
            picture(&parse(text, &topics).unwrap()),
            "a (x)
    -> scan           b
b (y, restarted on failure up to 3 times)
    <- scan           a
    -> votes          (no node of this graph)
"
        );
    }
}
