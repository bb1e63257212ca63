//! Errors of this crate's commands, and their exit codes.

use std::path::PathBuf;

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use launcher::LauncherError;
use recording::RecordingError;
use transport::TransportError;

/// Why recordings cannot be replayed and compared.
#[derive(Debug, thiserror::Error)]
pub enum RegressionError {
    /// The graph cannot be run.
    #[error(transparent)]
    Launcher(#[from] LauncherError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The graph cannot be joined, read or cleaned up.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// There is no recording to replay.
    #[error(
        "{} is not a folder with recording.mcap and map.yaml and contains none",
        folder.display()
    )]
    NoCases {
        /// Where they were looked for.
        folder: PathBuf,
    },
    /// What is expected of a recording is not written as it should be.
    #[error("{} does not say what is expected: --accept writes it again", file.display())]
    Expectation {
        /// The file.
        file: PathBuf,
        /// Where and why.
        source: serde_json::Error,
    },
    /// A graph did not answer every scan.
    #[error("{}: {answered} of {scans} scans were answered; see the graph's log", recording.display())]
    Unanswered {
        /// The recording.
        recording: PathBuf,
        /// Its scans.
        scans: usize,
        /// Scans with votes and hypotheses.
        answered: usize,
    },
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for RegressionError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Launcher(error) => error.exit_code(),
            Self::NoCases { .. } => WRONG_USE,
            _ => FAILED,
        }
    }
}
