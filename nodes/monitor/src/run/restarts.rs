//! Restarts of nodes by the launcher, which is asked as from a terminal.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use transport::{Graph, is_launched};

/// The command `backcast` beside this program, for a graph that it launched.
pub(super) struct Restarts {
    command: Option<PathBuf>,
    graph: String,
}

impl Restarts {
    pub(super) fn of(graph: &Graph) -> Self {
        let beside = std::env::current_exe().map(|own| own.with_file_name("backcast"));
        let command = beside.ok().filter(|command| command.is_file());
        Restarts {
            command: command.filter(|_| is_launched(graph.name())),
            graph: graph.name().to_string(),
        }
    }

    /// True if there is a launcher to ask.
    pub(super) fn are_possible(&self) -> bool {
        self.command.is_some()
    }

    /// Asks the launcher to restart a node; a refusal is logged.
    pub(super) fn ask(&self, node: String) {
        let Some(command) = &self.command else {
            return;
        };
        let mut command = Command::new(command);
        command.args(["restart", "--graph", &self.graph, "--", &node]);
        command.stdin(Stdio::null());
        // The launcher may take seconds to answer, and may stop this node.
        std::thread::spawn(move || match command.output() {
            Ok(output) if output.status.success() => {}
            Ok(output) => {
                let why = String::from_utf8_lossy(&output.stderr);
                tracing::warn!("{node} was not restarted: {}", why.trim());
            }
            Err(error) => tracing::warn!("{node} was not restarted: {error}"),
        });
    }
}
