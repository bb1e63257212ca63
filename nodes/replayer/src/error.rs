//! Errors of reading a recording and of sending it into the graph.

use std::path::PathBuf;

use recording::RecordingError;
use replay::PlaybackError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayerError {
    /// The recording cannot be opened.
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    /// The recording, or a message of it, cannot be read.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// Topics that were asked for are not there.
    #[error("{} has no {}; it has {}", path.display(), unknown.join(", "), found.join(", "))]
    UnknownTopics {
        /// The recording.
        path: PathBuf,
        /// Of --topics and --remap.
        unknown: Vec<String>,
        /// The recording's channels.
        found: Vec<String>,
    },
    /// Standard input cannot be read.
    #[error("cannot read the keyboard")]
    Keyboard(#[source] std::io::Error),
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl From<RecordingError> for ReplayerError {
    fn from(error: RecordingError) -> Self {
        ReplayerError::Recording(Box::new(error))
    }
}
