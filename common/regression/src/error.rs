//! Errors of this crate's commands, and their exit codes.

use std::path::PathBuf;

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use launcher::LauncherError;
use recording::RecordingError;
use transport::TransportError;

/// Errors of replaying and comparing recordings.
#[derive(Debug, thiserror::Error)]
pub enum RegressionError {
    #[error(transparent)]
    Launcher(#[from] LauncherError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Transport(#[from] TransportError),
    #[error(
        "{} is not a folder with recording.mcap and contains none",
        folder.display()
    )]
    NoCases { folder: PathBuf },
    #[error("{} has {found}, but no recording.mcap, recording.db3 or folder recording", folder.display())]
    HalfCase {
        folder: PathBuf,
        /// Name of the file that makes it look like a case.
        found: &'static str,
    },
    #[error("{} has no map.yaml, and its recording no map", folder.display())]
    NoMap { folder: PathBuf },
    #[error("{} does not say what is expected: --accept writes it again", file.display())]
    Expectation {
        file: PathBuf,
        source: serde_json::Error,
    },
    /// The graph has no result for some scans.
    #[error("{}: {answered} of {scans} scans were answered; see the graph's log", recording.display())]
    Unanswered {
        recording: PathBuf,
        scans: usize,
        /// Number of scans with votes and hypotheses.
        answered: usize,
    },
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for RegressionError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Launcher(error) => error.exit_code(),
            Self::NoCases { .. } | Self::HalfCase { .. } => WRONG_USE,
            _ => FAILED,
        }
    }
}
