//! Errors of playing a recording as a device.

use std::path::PathBuf;

use recording::RecordingError;
use replay::PlaybackError;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] Box<RecordingError>),
    /// A message of the recording cannot be read.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The recording has no scan.
    #[error("{}: there is no scan in it", path.display())]
    Empty {
        /// The recording.
        path: PathBuf,
    },
    /// A device's scans cannot look like those of the recording.
    #[error("scan {scan} of the recording: {field} is {found}, allowed is {allowed}")]
    Scan {
        /// Counted from 0.
        scan: usize,
        /// What does not fit.
        field: &'static str,
        /// Its value.
        found: f64,
        /// What a device can do.
        allowed: String,
    },
    /// The socket cannot be opened.
    #[error("cannot listen on {address}")]
    Listen {
        /// As configured.
        address: String,
        /// Why it failed.
        source: std::io::Error,
    },
    /// Waiting for clients failed.
    #[error("cannot wait for clients")]
    Wait(#[source] std::io::Error),
    /// The pseudo-terminal failed.
    #[error("pseudo-terminal: cannot {what}")]
    Terminal {
        /// What was tried.
        what: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The link to the pseudo-terminal cannot be made.
    #[error("{}: cannot make the link to the pseudo-terminal", path.display())]
    Link {
        /// As configured.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

impl From<RecordingError> for EmulatorError {
    fn from(error: RecordingError) -> Self {
        EmulatorError::Recording(Box::new(error))
    }
}
