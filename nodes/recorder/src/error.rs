//! Errors between the graph and the file.

use std::io;
use std::path::PathBuf;

use recording::RecordingError;

#[derive(Debug, thiserror::Error)]
pub enum RecorderError {
    /// A file cannot be created, read, written or synced: what was tried, and the system's error.
    #[error("{problem}")]
    File { problem: String, source: io::Error },
    #[error("{} and {tried} files with a number behind its name exist already", path.display())]
    NoFreeName { path: PathBuf, tried: u32 },
    #[error(transparent)]
    Sample(#[from] ros_graph::export::TranscriptError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("cannot catch SIGUSR1")]
    Signal(#[source] io::Error),
    #[error("cannot start the writer thread")]
    Thread(#[source] io::Error),
    #[error("the writer thread ended unexpectedly")]
    ThreadEnded,
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl RecorderError {
    /// Returns a function that converts an error of the system; `problem` says what was tried.
    pub(crate) fn file(problem: String) -> impl FnOnce(io::Error) -> Self {
        |source| RecorderError::File { problem, source }
    }
}
