//! Errors of this crate's commands, and their exit codes.

use std::{io, path::PathBuf};

use command_line::{CommandError, FAILED, OutputError};
use drawing::DrawingError;
use engine::heading::HeadingError;
use map::MapError;
use offline::OfflineError;
use recording::RecordingError;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// A scan cannot be searched.
    #[error(transparent)]
    Offline(#[from] OfflineError),
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
    /// A picture cannot be stored.
    #[error("cannot write the picture {}", file.display())]
    Picture {
        /// Its file.
        file: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// A map file cannot be used.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A scan whose heading is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
}

impl CommandError for PlotError {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Offline(error) => error.exit_code(),
            _ => FAILED,
        }
    }
}
