//! Errors that reject a request, and those that end the server.

use std::path::PathBuf;

use engine::EngineError;
use map::MapError;
use network_payload::WireError;
use transport::TransportError;
use zenoh_session::{KeyError, NetworkError};

use crate::request::ENCODINGS;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum LocateError {
    /// The map cannot be read.
    #[error("map {}", path.display())]
    Map {
        /// As configured.
        path: PathBuf,
        /// What is wrong, where, and what is allowed.
        source: Box<MapError>,
    },
    /// The map cannot be searched.
    #[error("map {} cannot be searched", path.display())]
    UnusableMap {
        /// As configured.
        path: PathBuf,
        /// What the engine says.
        source: EngineError,
    },
    /// The session cannot be opened.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The graph fails.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The request is in no form that is known.
    #[error("the request is {found:?}: allowed are {}", ENCODINGS.join(" and "))]
    Encoding {
        /// What it says of itself, cut to a few words.
        found: String,
    },
    /// The request is longer than a scan can be.
    #[error("a request of {found} bytes: allowed are at most {most}")]
    TooLong {
        /// Bytes.
        found: usize,
        /// Most bytes.
        most: usize,
    },
    /// A request in postcard, or an answer, that is not sound.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// A request in JSON that is not sound.
    #[error("the request is not a scan in JSON")]
    Json(#[from] serde_json::Error),
    /// `deadline_ms` of the request is not a time.
    #[error("deadline_ms={found:?}: allowed are 1 to 60000")]
    Deadline {
        /// What was found.
        found: String,
    },
    /// The scan is none that the engine can use.
    #[error("the scan is rejected")]
    Scan(#[from] EngineError),
    /// All servers have as much to do as they take on.
    #[error("busy: {waiting} scans are being searched or waiting, which is the limit")]
    Busy {
        /// At the server that was asked.
        waiting: usize,
    },
    /// The answer would have come after the deadline.
    #[error("late: no answer within {deadline_ms} ms")]
    Late {
        /// As asked, milliseconds.
        deadline_ms: u128,
    },
    /// A server says so.
    #[error("the server rejects the request: {says}")]
    Refused {
        /// In its words.
        says: String,
    },
}

/// What a server says that does not answer: the encodings of its replies.
pub const BUSY: &str = "text/plain;backcast.Busy/v1";
/// As [`BUSY`], where the time is over.
pub const LATE: &str = "text/plain;backcast.Late/v1";
/// As [`BUSY`], where asking again does not help.
pub const REFUSED: &str = "text/plain;backcast.Refused/v1";

impl LocateError {
    /// How a reply says which of them it is.
    #[must_use]
    pub fn encoding(&self) -> &'static str {
        match self {
            LocateError::Busy { .. } => BUSY,
            LocateError::Late { .. } => LATE,
            _ => REFUSED,
        }
    }
}
