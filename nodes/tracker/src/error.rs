//! Errors that end the node, and errors that reject a scan.

use engine::EngineError;
use transport::TransportError;

#[derive(Debug, thiserror::Error)]
pub enum TrackerError {
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    #[error("the last pose in {file} cannot be used: {reason}")]
    Memory { file: String, reason: String },
    #[error(transparent)]
    Transport(#[from] TransportError),
}
