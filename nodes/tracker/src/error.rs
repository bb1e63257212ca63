//! Errors that end the node, and those that reject a scan.

use engine::EngineError;
use transport::TransportError;

/// A scan or a map that is refused, a file that cannot be used, or a failure of the graph.
#[derive(Debug, thiserror::Error)]
pub enum TrackerError {
    /// The engine refused the map or the scan.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The map is not the one that its id says.
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    /// The set of maps is none.
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    /// The file of the last pose cannot be used.
    #[error("the last pose in {file} cannot be used: {reason}")]
    Memory {
        /// As it was named.
        file: String,
        /// What is wrong.
        reason: String,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
