//! Errors of reading a recording and sending it into the graph.

use std::path::PathBuf;

use recording::RecordingError;
use ros_graph::replay::PlaybackError;

#[derive(Debug, thiserror::Error)]
pub enum ReplayerError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    #[error("{} has no {}; it has {}", path.display(), unknown.join(", "), found.join(", "))]
    UnknownTopics {
        path: PathBuf,
        unknown: Vec<String>,
        found: Vec<String>,
    },
    #[error("cannot read the keyboard")]
    Keyboard(#[source] std::io::Error),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
