//! Errors that reject a map, and those that end the node.

use engine::EngineError;
use transport::TransportError;

/// A map that is refused, or a failure of the graph.
#[derive(Debug, thiserror::Error)]
pub enum BoundaryError {
    /// The map's geometry or cells cannot be used.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The map is not the one that its id says.
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    /// No ray can reach an obstacle.
    #[error(
        "the map has {occupied} occupied cells, but none touches a cell that a laser sees \
         through: there is nothing that it could see"
    )]
    NoBoundaryCell {
        /// Occupied cells.
        occupied: usize,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
