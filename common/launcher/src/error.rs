//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf, process::ExitStatus};

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use dataflow::DataflowError;
use transport::TransportError;

/// Error of a command of this crate.
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
        /// Path as given by the user.
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
        option: &'static str,
        /// Executable that the option applies to.
        executable: String,
        file: PathBuf,
        /// Executables of the graph's nodes, separated by commas.
        found: String,
    },
    /// An option needs an input that is not wired.
    #[error("{option} needs the input `{topic}` at node {node}, but {} wires none", file.display())]
    NotWired {
        option: &'static str,
        topic: &'static str,
        /// Node that needs the input.
        node: String,
        file: PathBuf,
    },
    /// No graph of this user is running.
    #[error("no graph of this user is running{}", others.iter().map(|other| format!("; {other}")).collect::<String>())]
    NoGraph {
        /// A sentence for each graph that another user runs.
        others: Vec<String>,
    },
    /// A graph is still running after it was asked to stop.
    #[error(
        "graph {graph} still runs {seconds} s after it was asked to stop: `backcast status` shows what runs"
    )]
    NotStopped {
        graph: String,
        /// Time waited, in seconds.
        seconds: u64,
    },
    /// No launcher answers.
    #[error("no launcher of graph {graph} answers: `backcast status` lists the graphs that run")]
    NoLauncher {
        graph: String,
        /// Error of the connection.
        source: io::Error,
    },
    /// Options that exclude each other or are invalid.
    #[error("{0}")]
    Usage(String),
    /// A build could not be started.
    #[error(
        "node {node}: the build `{command}` cannot be started; where all executables are there, \
         --no-build runs them as they are"
    )]
    BuildNotStarted {
        node: String,
        command: String,
        source: io::Error,
    },
    /// The build program is not installed and executables are missing.
    #[error(
        "{program} is not installed, and there are no executables of {missing}: install what \
         `{command}` needs (Rust: https://rustup.rs), or get the nodes built, as a package or by \
         packaging/install elsewhere (docs/install.md), and name them in the descriptor without a folder"
    )]
    NothingToRun {
        /// The missing build program.
        program: String,
        /// The build command.
        command: String,
        /// Nodes without an executable, separated by commas.
        missing: String,
    },
    /// A build failed.
    #[error("node {node}: the build `{command}` failed with {status}")]
    BuildFailed {
        node: String,
        command: String,
        /// Exit status of the build.
        status: ExitStatus,
    },
    /// A process could not be started.
    #[error("node {node}: {} cannot be started in {}", path.display(), folder.display())]
    NotStarted {
        node: String,
        path: PathBuf,
        /// Working directory of the process.
        folder: PathBuf,
        source: io::Error,
    },
    /// Arguments that the descriptor gives to nodes are wrong, or cannot be checked.
    #[error("{}: {refused}", file.display())]
    Arguments {
        file: PathBuf,
        /// Error message of each node, one per line.
        refused: String,
    },
    /// A process could not be waited for or signalled.
    #[error("node {node}: process {pid} cannot be supervised")]
    NotSupervised {
        node: String,
        pid: i32,
        source: io::Error,
    },
    /// A node failed and is not restarted.
    #[error("node {node} ended with {status}{}; see its last log lines", after(*restarts))]
    NodeFailed {
        node: String,
        status: ExitStatus,
        /// Number of restarts before.
        restarts: u32,
    },
    /// The graph cannot be joined, read or cleaned up.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A file cannot be read or written.
    #[error("cannot {action} {}", file.display())]
    File {
        /// Verb of what was tried.
        action: &'static str,
        file: PathBuf,
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
    /// Standard output cannot be written.
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
