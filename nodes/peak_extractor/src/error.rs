//! Errors that reject votes, and errors that end the node.

use engine::EngineError;
use transport::TransportError;

#[derive(Debug, thiserror::Error)]
pub enum PeakError {
    #[error(
        "they are of map {found:016x}, which is not known; known are the newest map and the one \
         before: {known}"
    )]
    UnknownMap { found: u64, known: String },
    #[error("their scan is not known: it was not received, or too long ago")]
    UnknownScan,
    #[error("which of them are on which map is not known: it was not received, or too long ago")]
    UnknownParts,
    /// Votes that contradict themselves, and how.
    #[error("{0}")]
    Votes(String),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    #[error(transparent)]
    Transport(#[from] TransportError),
}
