//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf, process::ExitStatus};

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use dataflow::DataflowError;
use transport::TransportError;

/// Why a graph cannot be run or asked.
#[derive(Debug, thiserror::Error)]
pub enum LauncherError {
    /// The descriptor cannot be used.
    #[error(transparent)]
    Dataflow(#[from] DataflowError),
    /// There is no descriptor.
    #[error(
        "there is no file {} in {}: run in a folder that has one, as the repository's root does, or name it: `backcast run path/to/dataflow.yaml`",
        file.display(),
        folder.display()
    )]
    NoDescriptor {
        /// As it was given.
        file: PathBuf,
        /// The current directory.
        folder: PathBuf,
    },
    /// An option is for a node that the graph does not have.
    #[error(
        "{option} is for the {executable}, but no node in {} has a path that ends so; its executables are {found}",
        file.display()
    )]
    NoNodeForOption {
        /// The option.
        option: &'static str,
        /// Whose option it is.
        executable: String,
        /// The descriptor.
        file: PathBuf,
        /// What the graph has instead.
        found: String,
    },
    /// An option needs an input that is not wired.
    #[error("{option} needs the input `{topic}` at node {node}, but {} wires none", file.display())]
    NotWired {
        /// The option.
        option: &'static str,
        /// The topic.
        topic: &'static str,
        /// The node that should take it.
        node: String,
        /// The descriptor.
        file: PathBuf,
    },
    /// No graph is there to be asked.
    #[error("no graph of this user is running{}", others.iter().map(|other| format!("; {other}")).collect::<String>())]
    NoGraph {
        /// A sentence on each graph that another user runs.
        others: Vec<String>,
    },
    /// A graph that was asked to stop runs on.
    #[error(
        "graph {graph} still runs {seconds} s after it was asked to stop: `backcast status` shows what runs"
    )]
    NotStopped {
        /// The graph's name.
        graph: String,
        /// How long was waited.
        seconds: u64,
    },
    /// No launcher answers.
    #[error("no launcher of graph {graph} answers: `backcast status` lists the graphs that run")]
    NoLauncher {
        /// The graph's name.
        graph: String,
        /// Why not.
        source: io::Error,
    },
    /// Options that do not go together.
    #[error("{0}")]
    Usage(String),
    /// A build could not be started.
    #[error(
        "node {node}: the build `{command}` cannot be started; where all executables are there, \
         --no-build runs them as they are"
    )]
    BuildNotStarted {
        /// The node.
        node: String,
        /// Its command.
        command: String,
        /// Why not.
        source: io::Error,
    },
    /// What builds is not installed, and there is nothing to run.
    #[error(
        "{program} is not installed, and there are no executables of {missing}: install what \
         `{command}` needs (Rust: https://rustup.rs), or get the nodes built, as a package or by \
         packaging/install elsewhere (docs/install.md), and name them in the descriptor without a folder"
    )]
    NothingToRun {
        /// The program that builds.
        program: String,
        /// Its command.
        command: String,
        /// The nodes whose executables are missing.
        missing: String,
    },
    /// A build failed.
    #[error("node {node}: the build `{command}` failed with {status}")]
    BuildFailed {
        /// The node.
        node: String,
        /// Its command.
        command: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// A process could not be started.
    #[error("node {node}: {} cannot be started in {}", path.display(), folder.display())]
    NotStarted {
        /// The node.
        node: String,
        /// Its executable.
        path: PathBuf,
        /// Its working directory.
        folder: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Nodes do not take the arguments that the descriptor gives them.
    #[error("{}: {refused}", file.display())]
    Arguments {
        /// The descriptor.
        file: PathBuf,
        /// What each of them said, a line each.
        refused: String,
    },
    /// A process could not be waited for or signalled.
    #[error("node {node}: process {pid} cannot be supervised")]
    NotSupervised {
        /// The node.
        node: String,
        /// Its process.
        pid: i32,
        /// Why not.
        source: io::Error,
    },
    /// A node failed, and is not started again.
    #[error("node {node} ended with {status}{}; see its last log lines", after(*restarts))]
    NodeFailed {
        /// The node.
        node: String,
        /// How it ended.
        status: ExitStatus,
        /// How often it was started again before.
        restarts: u32,
    },
    /// The graph cannot be joined, read or cleaned up.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A file cannot be read or written.
    #[error("cannot {action} {}", file.display())]
    File {
        /// What was tried, as a verb.
        action: &'static str,
        /// With what.
        file: PathBuf,
        /// Why it failed.
        source: io::Error,
    },
    /// The service manager that started us cannot be notified.
    #[error("cannot notify the service manager: NOTIFY_SOCKET is not one of its sockets")]
    Notify(#[source] io::Error),
    /// A signal cannot be caught.
    #[error("cannot catch signals")]
    Signal(#[source] io::Error),
    /// Logging cannot be started.
    #[error("{0}")]
    Logging(String),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The current directory cannot be found.
    #[error("cannot find the current directory")]
    Folder(#[source] io::Error),
}

impl CommandError for LauncherError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::NoDescriptor { .. }
            | Self::NoNodeForOption { .. }
            | Self::NotWired { .. }
            | Self::Usage(_)
            | Self::Logging(_) => WRONG_USE,
            _ => FAILED,
        }
    }
}

fn after(restarts: u32) -> String {
    match restarts {
        0 => String::new(),
        1 => " after 1 restart in short time".to_owned(),
        n => format!(" after {n} restarts in short time"),
    }
}
