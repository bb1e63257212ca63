//! Errors between the graph and the file.

use std::io;
use std::path::PathBuf;

use recording::RecordingError;

/// Error of the node, with the value found and the values allowed.
#[derive(Debug, thiserror::Error)]
pub enum RecorderError {
    #[error("cannot create the recording {}", path.display())]
    Create {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    #[error("cannot end the recording {}: what was flushed before that is readable", path.display())]
    Finish {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Data that was written may not be on the disk yet.
    #[error("cannot sync the recording {} to the disk", path.display())]
    Sync {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A saved black box could not be written.
    #[error("cannot write {}", path.display())]
    Save {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    #[error("{} and {tried} files with a number behind its name exist already", path.display())]
    NoFreeName {
        /// Path from the configuration.
        path: PathBuf,
        /// Number of variants tried.
        tried: u32,
    },
    #[error("cannot read {}, which is to be put into the recording", path.display())]
    Attach {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A sample cannot be recorded.
    #[error(transparent)]
    Sample(#[from] ros_export::TranscriptError),
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    #[error("cannot catch SIGUSR1")]
    Signal(#[source] io::Error),
    #[error("cannot start the writer thread")]
    Thread(#[source] io::Error),
    #[error("the writer thread ended unexpectedly")]
    ThreadEnded,
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl From<RecordingError> for RecorderError {
    fn from(error: RecordingError) -> Self {
        RecorderError::Recording(Box::new(error))
    }
}
