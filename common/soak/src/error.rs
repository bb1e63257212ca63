//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError};
use launcher::LauncherError;
use map::MapError;
use recording::RecordingError;
use transport::TransportError;

/// Errors of running a graph under faults.
#[derive(Debug, thiserror::Error)]
pub enum SoakError {
    #[error(transparent)]
    Launcher(#[from] LauncherError),
    #[error(transparent)]
    Map(#[from] MapError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Transport(#[from] TransportError),
    #[error("{} has no true poses on /ground_truth: nothing to compare with", file.display())]
    NoTruths { file: PathBuf },
    #[error("cannot start, signal or wait for the processes of the graph")]
    NotLaunched(#[source] io::Error),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for SoakError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Launcher(error) => error.exit_code(),
            _ => FAILED,
        }
    }
}
