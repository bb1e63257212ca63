//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError};
use engine::heading::HeadingError;
use map::MapError;
use offline::OfflineError;
use plots::PlotError;
use recording::RecordingError;

/// Errors of `locate` and `evaluate`.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationError {
    #[error(transparent)]
    Offline(#[from] OfflineError),
    #[error(transparent)]
    Plot(#[from] PlotError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Map(#[from] MapError),
    /// A file cannot be written, or a folder cannot be created.
    #[error("cannot {action} {}", .file.display())]
    File {
        /// Verb of the failed action, such as `write`.
        action: &'static str,
        file: PathBuf,
        source: io::Error,
    },
    #[error("cannot read the peak of memory from /proc/self/status")]
    Memory(#[source] io::Error),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Heading(#[from] HeadingError),
}

impl CommandError for EvaluationError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Offline(error) => error.exit_code(),
            Self::Plot(error) => error.exit_code(),
            _ => FAILED,
        }
    }
}
