//! Why no descriptor was written.

use std::io;
use std::path::PathBuf;

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use launcher::LauncherError;
use map::MapError;
use probe::ProbeError;
use recording::RecordingError;

/// Why no descriptor was written.
#[derive(Debug, thiserror::Error)]
pub enum InitError {
    /// The laser cannot be asked.
    #[error(
        "the laser gives no answer; --no-probe writes the descriptor without asking it, and \
         `backcast probe {device}` says more"
    )]
    Laser {
        /// As it was given.
        device: String,
        /// Why not.
        source: ProbeError,
    },
    /// The robot cannot be looked at.
    #[error("the robot cannot be looked at: {reason}; --no-probe writes the descriptor without")]
    Robot {
        /// Why not.
        reason: String,
    },
    /// The robot's messages cannot be recorded.
    #[error("the robot cannot be recorded: {reason}")]
    Record {
        /// Why not.
        reason: String,
    },
    /// The map cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Two options do not go together.
    #[error("{0}")]
    Usage(String),
    /// The descriptor stands already.
    #[error("{} is there already; --force overwrites it", file.display())]
    Exists {
        /// The file.
        file: PathBuf,
    },
    /// It cannot be written.
    #[error("cannot write {}", file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// What was written is not sound here.
    #[error(transparent)]
    Check(#[from] LauncherError),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for InitError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::Exists { .. } => WRONG_USE,
            _ => FAILED,
        }
    }
}
