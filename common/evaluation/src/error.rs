//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError};
use engine::heading::HeadingError;
use map::MapError;
use offline::OfflineError;
use plots::PlotError;
use recording::RecordingError;

/// Why nothing can be found or judged.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationError {
    /// A scan cannot be searched.
    #[error(transparent)]
    Offline(#[from] OfflineError),
    /// A picture cannot be made.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A file could not be written, or a folder not be made.
    #[error("cannot {action} {}", .file.display())]
    File {
        /// The verb of what failed, as `write`.
        action: &'static str,
        /// Where it was to be.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The process's memory cannot be read.
    #[error("cannot read the peak of memory from /proc/self/status")]
    Memory(#[source] io::Error),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A scan whose heading is not known.
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
