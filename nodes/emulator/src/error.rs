//! Errors while playing a recording as a device.

use std::path::PathBuf;

use recording::RecordingError;
use ros_graph::replay::PlaybackError;

#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    #[error("{}: there is no scan in it", path.display())]
    Empty { path: PathBuf },
    /// A scan of the recording cannot be sent by a device.
    #[error("scan {scan} of the recording: {field} is {found}, allowed is {allowed}")]
    Scan {
        scan: usize,
        field: &'static str,
        found: f64,
        allowed: String,
    },
    #[error("cannot listen on {address}")]
    Listen {
        address: String,
        source: std::io::Error,
    },
    #[error("cannot wait for clients")]
    Wait(#[source] std::io::Error),
    #[error("pseudo-terminal: cannot {what}")]
    Terminal {
        what: &'static str,
        source: std::io::Error,
    },
    #[error("{}: cannot make the link to the pseudo-terminal", path.display())]
    Link {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
