//! Errors between the graph and the file.

use std::io;
use std::path::PathBuf;

use recording::RecordingError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum RecorderError {
    /// A file cannot be created.
    #[error("cannot create the recording {}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A recording could not be ended.
    #[error("cannot end the recording {}: what was flushed before that is readable", path.display())]
    Finish {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// What was written may not be on the disk yet.
    #[error("cannot sync the recording {} to the disk", path.display())]
    Sync {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A saved black box could not be written.
    #[error("cannot write {}", path.display())]
    Save {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// As many files as are tried have the recording's name.
    #[error("{} and {tried} files with a number behind its name exist already", path.display())]
    NoFreeName {
        /// The name that was asked for.
        path: PathBuf,
        /// Numbers that were tried.
        tried: u32,
    },
    /// A file that is to be attached cannot be read.
    #[error("cannot read {}, which is to be put into the recording", path.display())]
    Attach {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A sample that has no place in a recording.
    #[error(transparent)]
    Sample(#[from] ros_export::TranscriptError),
    /// The recording cannot be written.
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    /// SIGUSR1 cannot be caught.
    #[error("cannot catch SIGUSR1")]
    Signal(#[source] io::Error),
    /// The thread that writes cannot be started.
    #[error("cannot start the writer thread")]
    Thread(#[source] io::Error),
    /// The thread that writes is gone.
    #[error("the writer thread ended unexpectedly")]
    ThreadEnded,
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl From<RecordingError> for RecorderError {
    fn from(error: RecordingError) -> Self {
        RecorderError::Recording(Box::new(error))
    }
}
