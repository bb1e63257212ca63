//! Errors while playing a recording as a device.

use std::io;

use recording::RecordingError;
use ros_graph::replay::PlaybackError;

#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    #[error("{what}")]
    Io { what: String, source: io::Error },
    /// The recording cannot be sent by a device.
    #[error("{0}")]
    Recorded(String),
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl EmulatorError {
    pub(crate) fn io(what: impl Into<String>, error: impl Into<io::Error>) -> Self {
        EmulatorError::Io {
            what: what.into(),
            source: error.into(),
        }
    }

    /// Returns the error for a value in a scan of the recording.
    pub(crate) fn scan(scan: usize, field: &str, found: f64, allowed: &str) -> Self {
        EmulatorError::Recorded(format!(
            "scan {scan} of the recording: {field} is {found}, allowed is {allowed}"
        ))
    }
}
