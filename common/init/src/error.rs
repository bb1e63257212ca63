//! Errors of `backcast init`.

use std::io;
use std::path::PathBuf;

use command_line::{CommandError, FAILED, OutputError, WRONG_USE};
use launcher::LauncherError;
use map::MapError;
use probe::ProbeError;
use recording::RecordingError;

/// Reason why no descriptor was written.
#[derive(Debug, thiserror::Error)]
pub enum InitError {
    /// The laser does not answer.
    #[error(
        "the laser gives no answer; --no-probe writes the descriptor without asking it, and \
         `backcast probe {device}` says more"
    )]
    Laser {
        /// Address or device as given.
        device: String,
        source: ProbeError,
    },
    /// The robot's nodes cannot be listed.
    #[error("the robot cannot be looked at: {reason}; --no-probe writes the descriptor without")]
    Robot {
        /// Description of the error.
        reason: String,
    },
    /// The robot's messages cannot be recorded.
    #[error("the robot cannot be recorded: {reason}")]
    Record {
        /// Description of the error.
        reason: String,
    },
    /// The map cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Options that exclude each other or are missing.
    #[error("{0}")]
    Usage(String),
    /// The descriptor cannot be written.
    #[error("cannot write {}", file.display())]
    Write {
        /// Path as given.
        file: PathBuf,
        source: io::Error,
    },
    /// The written descriptor is invalid on this machine.
    #[error(transparent)]
    Check(#[from] LauncherError),
    /// Standard output cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for InitError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => WRONG_USE,
            Self::Write { source, .. } if source.kind() == io::ErrorKind::AlreadyExists => {
                WRONG_USE
            }
            _ => FAILED,
        }
    }
}
