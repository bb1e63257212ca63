//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError};
use launcher::LauncherError;
use map::MapError;
use recording::RecordingError;
use transport::TransportError;

/// Why a graph cannot be run for long.
#[derive(Debug, thiserror::Error)]
pub enum SoakError {
    /// The graph cannot be run.
    #[error(transparent)]
    Launcher(#[from] LauncherError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The graph cannot be joined, read or cleaned up.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A recording by which nothing can be judged.
    #[error("{} has no true poses on /ground_truth: nothing to compare with", file.display())]
    NoTruths {
        /// The recording.
        file: PathBuf,
    },
    /// The launcher cannot be started as a child process, or not be signalled.
    #[error("cannot start, signal or wait for the processes of the graph")]
    NotLaunched(#[source] io::Error),
    /// Standard output takes no more.
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
