//! All that can end a command early, and the exit code that it means.

use std::{io, path::PathBuf, process::ExitStatus};

use benchmarks::BenchmarksError;
use dataflow::DataflowError;
use drawing::DrawingError;
use engine::EngineError;
use engine::heading::HeadingError;
use map::MapError;
use recording::RecordingError;
use simulation::SimulationError;
use transport::TransportError;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum BackcastError {
    /// The descriptor cannot be used.
    #[error(transparent)]
    Dataflow(#[from] DataflowError),
    /// Prepared maps cannot be kept.
    #[error(transparent)]
    IndexCache(#[from] index_cache::CacheError),
    /// A message cannot be one of the graph.
    #[error(transparent)]
    Conversion(#[from] conversion::Unsayable),
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
    /// A monitor does not answer, or not as one does.
    #[error("no monitor answers at {address}: is a graph running? ({reason})")]
    NoMonitor {
        /// Host and port.
        address: String,
        /// What went wrong.
        reason: String,
    },
    /// The monitor does not know the robot.
    #[error("the monitor at {address} knows no robot {robot:?}; it knows {}", known.join(", "))]
    NoRobot {
        /// Host and port.
        address: String,
        /// As it was given.
        robot: String,
        /// The robots that it knows.
        known: Vec<String>,
    },
    /// No launcher answers.
    #[error("no launcher of graph {graph} answers: `backcast status` lists the graphs that run")]
    NoLauncher {
        /// The graph's name.
        graph: String,
        /// Why not.
        source: io::Error,
    },
    /// The terminal cannot be used.
    #[error("cannot use the terminal")]
    Terminal(#[source] io::Error),
    /// Options that do not go together.
    #[error("{0}")]
    Usage(String),
    /// A build could not be started.
    #[error("node {node}: the build `{command}` cannot be started")]
    BuildNotStarted {
        /// The node.
        node: String,
        /// Its command.
        command: String,
        /// Why not.
        source: io::Error,
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
    #[error("node {node} ended with {status}{}; its own last lines say why", after(*restarts))]
    NodeFailed {
        /// The node.
        node: String,
        /// How it ended.
        status: ExitStatus,
        /// How often it was started again before.
        restarts: u32,
    },
    /// The graph cannot be joined, heard or cleaned up.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// There is no map to search.
    #[error(
        "{} has no map on /map: name one with --map map.yaml",
        recording.display()
    )]
    NoMap {
        /// The recording.
        recording: PathBuf,
    },
    /// A map that is sound, but on which nothing can be found.
    #[error("{} cannot be searched", file.display())]
    UnusableMap {
        /// The map's file, or the recording that holds it.
        file: PathBuf,
        /// Why not.
        source: EngineError,
    },
    /// No map that counts for a scan can be used.
    #[error("{}: no map up to this scan can be searched: {reason}", file.display())]
    NoUsableMap {
        /// The recording that holds the maps.
        file: PathBuf,
        /// Why the last one cannot.
        reason: String,
    },
    /// No scan was accepted.
    #[error("{}: every scan was refused, {scans} in all; the first: {reason}", file.display())]
    AllRefused {
        /// The recording.
        file: PathBuf,
        /// Scans that were taken.
        scans: u64,
        /// Why the first was.
        reason: String,
    },
    /// A setting of the engine is out of range.
    #[error(transparent)]
    Setting(EngineError),
    /// A scan is refused.
    #[error(transparent)]
    Refused(EngineError),
    /// A scan whose heading is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
    /// A recording by which nothing can be judged.
    #[error("{} has no true poses on /ground_truth: there is nothing to judge by", file.display())]
    NoTruths {
        /// The recording.
        file: PathBuf,
    },
    /// A recording whose true poses are of other scans than those taken.
    #[error(
        "{}: none of the {scans} scans taken has a true pose; the file holds {truths}, of other scans",
        file.display()
    )]
    NoTruthTaken {
        /// The recording.
        file: PathBuf,
        /// Scans that were taken.
        scans: u64,
        /// True poses in the recording.
        truths: usize,
    },
    /// A recording that has fewer scans than the number of the one asked for.
    #[error(
        "{}: there is no scan {wanted}; the scans taken are 1 to {found}",
        file.display()
    )]
    NoSuchScan {
        /// The recording.
        file: PathBuf,
        /// The number asked for, from 1.
        wanted: u64,
        /// Scans that are taken.
        found: u64,
    },
    /// A scan that has no best place to draw anything at.
    #[error("{}: scan {number} has no place on this map: {says}", file.display())]
    NoPlace {
        /// The recording.
        file: PathBuf,
        /// The scan's number, from 1.
        number: u64,
        /// The verdict in words.
        says: String,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// A trajectory could not be written.
    #[error("cannot write the trajectory {}", .file.display())]
    Trajectory {
        /// Where it was to be.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A picture cannot be stored.
    #[error("cannot write the picture {}", file.display())]
    Picture {
        /// Its file.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A folder cannot be made, or not be written into.
    #[error("cannot write into the folder {}", folder.display())]
    OutFolder {
        /// As it was given.
        folder: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A table cannot be stored.
    #[error("cannot write the table {}", file.display())]
    Table {
        /// Its file.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// There is no recording to replay.
    #[error(
        "{} holds no folder with recording.mcap and map.yaml, and is none",
        folder.display()
    )]
    NoCases {
        /// Where they were looked for.
        folder: PathBuf,
    },
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
    /// What is expected of a recording is not written as it should be.
    #[error("{} does not say what is expected: --accept writes it anew", file.display())]
    Expectation {
        /// The file.
        file: PathBuf,
        /// Where and why.
        source: serde_json::Error,
    },
    /// A laser log cannot be read or written on.
    #[error("the log cannot be read or written to its end")]
    Log(#[source] io::Error),
    /// A file to convert holds nothing that can be.
    #[error("nothing in {} could be converted, and no file was written: {reason}", file.display())]
    NothingConverted {
        /// The file.
        file: PathBuf,
        /// What it holds instead.
        reason: String,
    },
    /// A graph did not answer every scan.
    #[error("{}: {answered} of {scans} scans were answered; the graph's own lines say why", recording.display())]
    Unanswered {
        /// The recording.
        recording: PathBuf,
        /// Its scans.
        scans: usize,
        /// Scans with votes and hypotheses.
        answered: usize,
    },
    /// The service manager that started us cannot be told of it.
    #[error("cannot tell the service manager: NOTIFY_SOCKET names no socket of one")]
    Notify(#[source] io::Error),
    /// The launcher cannot be started as a child process, or not be signalled.
    #[error("cannot start, signal or wait for the processes of the graph")]
    NotLaunched(#[source] io::Error),
    /// A signal cannot be caught.
    #[error("cannot catch signals")]
    Signal(#[source] io::Error),
    /// A drive cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A case of the bench cannot be set up.
    #[error(transparent)]
    Benchmarks(#[from] BenchmarksError),
    /// The thread's processor time cannot be read.
    #[error("cannot read the processor time of a thread")]
    Clock(#[source] nix::Error),
    /// The process's memory cannot be read.
    #[error("cannot read the peak of memory from /proc/self/status")]
    Memory(#[source] io::Error),
    /// Logging cannot be started.
    #[error("{0}")]
    Logging(String),
    /// Standard output takes no more.
    #[error("cannot write to standard output")]
    Output(#[source] io::Error),
    /// A laser cannot be reached, or hung up.
    #[error("{address}: no device can be reached; check its power, cable and address")]
    DeviceNotReached {
        /// As it was given, with the port that was tried last.
        address: String,
        /// Why not.
        source: io::Error,
    },
    /// Something is there, but no laser that we know.
    #[error(
        "{address}: no laser answers; tried {tried}; {}",
        match heard {
            0 => "nothing came".to_owned(),
            n => format!("{n} bytes came that are no answer: is it another device, or in use?"),
        }
    )]
    DeviceNotUnderstood {
        /// As it was given, with the port that was tried last.
        address: String,
        /// Bytes that came.
        heard: usize,
        /// In which ways it was asked.
        tried: String,
    },
    /// The current directory cannot be told.
    #[error("cannot tell the current directory")]
    Folder(#[source] io::Error),
}

impl BackcastError {
    /// 2 where the command was used wrongly, else 1.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::NoDescriptor { .. }
            | Self::NoNodeForOption { .. }
            | Self::NotWired { .. }
            | Self::NoCases { .. }
            | Self::Usage(_)
            | Self::Setting(_)
            | Self::Logging(_) => crate::cli::WRONG_USE,
            _ => 1,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn causes_are_told_once() {
        let output = BackcastError::Output(io::Error::other("the disk is full"));
        assert_eq!(
            transport::with_causes(&output),
            "cannot write to standard output: the disk is full"
        );
        let recording: BackcastError = RecordingError::Open {
            path: "r.mcap".into(),
            source: io::Error::other("gone"),
        }
        .into();
        assert_eq!(
            transport::with_causes(&recording),
            "cannot read the recording r.mcap: gone"
        );
    }
}
