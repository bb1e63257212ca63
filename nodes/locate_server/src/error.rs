//! Errors that reject a request, and errors that end the server.

use std::path::PathBuf;

use engine::EngineError;
use map::MapError;
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

use crate::request::ENCODINGS;

#[derive(Debug, thiserror::Error)]
pub enum LocateError {
    #[error("map {}", path.display())]
    Map {
        path: PathBuf,
        source: Box<MapError>,
    },
    #[error("map {} cannot be searched", path.display())]
    UnusableMap { path: PathBuf, source: EngineError },
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error(transparent)]
    Key(#[from] KeyError),
    #[error(transparent)]
    Transport(#[from] TransportError),
    #[error("the request is {found:?}: allowed are {}", ENCODINGS.join(" and "))]
    Encoding { found: String },
    #[error("a request of {found} bytes: allowed are at most {most}")]
    TooLong { found: usize, most: usize },
    #[error(transparent)]
    Wire(#[from] WireError),
    #[error("the request is not a scan in JSON")]
    Json(#[from] serde_json::Error),
    #[error("deadline_ms={found:?}: allowed are 1 to 60000")]
    Deadline { found: String },
    #[error("the scan is rejected")]
    Scan(#[from] EngineError),
    #[error("busy: {waiting} scans are being searched or waiting, which is the limit")]
    Busy { waiting: usize },
    #[error("late: no answer within {deadline_ms} ms")]
    Late { deadline_ms: u128 },
    #[error("the server rejects the request: {says}")]
    Refused { says: String },
}

/// Encoding of the error reply of a busy server.
pub const BUSY: &str = "text/plain;backcast.Busy/v1";
/// Encoding of the error reply after the deadline.
pub const LATE: &str = "text/plain;backcast.Late/v1";
/// Encoding of the error reply if repeating the request does not help.
pub const REFUSED: &str = "text/plain;backcast.Refused/v1";

impl LocateError {
    pub fn encoding(&self) -> &'static str {
        match self {
            LocateError::Busy { .. } => BUSY,
            LocateError::Late { .. } => LATE,
            _ => REFUSED,
        }
    }
}
