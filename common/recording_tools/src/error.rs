//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use map::MapError;
use offline::OfflineError;
use recording::RecordingError;
use simulation::SimulationError;

/// Error of the commands of this crate.
#[derive(Debug, thiserror::Error)]
pub enum RecordingToolsError {
    /// A scan cannot be searched.
    #[error(transparent)]
    Offline(#[from] OfflineError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A message cannot be one of the graph.
    #[error(transparent)]
    Conversion(#[from] ros::ConversionError),
    /// A drive cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A file cannot be read or written.
    #[error("cannot {action} {}", file.display())]
    File {
        /// Attempted action, as a verb.
        action: &'static str,
        file: PathBuf,
        source: io::Error,
    },
    /// A file to convert contains nothing that can be converted.
    #[error("nothing in {} could be converted, and no file was written: {reason}", file.display())]
    NothingConverted {
        file: PathBuf,
        /// Description of its content.
        reason: String,
    },
    /// Incompatible options.
    #[error("{0}")]
    Usage(String),
    /// Standard output is closed.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for RecordingToolsError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Offline(error) => error.exit_code(),
            Self::Usage(_) => WRONG_USE,
            _ => FAILED,
        }
    }
}
