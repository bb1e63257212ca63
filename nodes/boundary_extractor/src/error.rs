//! Errors that reject a map, and errors that end the node.

use engine::EngineError;
use transport::TransportError;

#[derive(Debug, thiserror::Error)]
pub enum BoundaryError {
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    #[error(
        "the map has {occupied} occupied cells, but none touches a cell that a laser sees \
         through: there is nothing that it could see"
    )]
    NoBoundaryCell { occupied: usize },
    #[error(transparent)]
    Transport(#[from] TransportError),
}
