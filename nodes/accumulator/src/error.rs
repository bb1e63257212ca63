//! Errors that reject a scan or a map, or stop the node.

use engine::EngineError;
use engine::heading::HeadingError;
use transport::TransportError;

#[derive(Debug, thiserror::Error)]
pub enum AccumulatorError {
    #[error("a search is asked for, but the scan is not among the last 64, or was searched")]
    NotKept,
    #[error("there is no map yet")]
    NoMap,
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    #[error(transparent)]
    Rule(#[from] messages::InvalidRule),
    #[error(transparent)]
    Heading(#[from] HeadingError),
    #[error(
        "the scan has {found} readings: a ring of sonars, as which it is to be read, has at most \
         {allowed}"
    )]
    TooManyEchoes { found: usize, allowed: usize },
    #[error("the boundary came with {found} cells instead of {expected}")]
    BoundarySize { expected: u64, found: usize },
    #[error("cannot start a thread to prepare map {map_id:016x}")]
    Thread { map_id: u64, source: std::io::Error },
    #[error("preparing map {map_id:016x} died: {reason}")]
    PreparationDied { map_id: u64, reason: String },
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl AccumulatorError {
    /// Returns true if the error is that no pose of the map is allowed by the search region.
    pub(crate) fn leaves_no_pose(&self) -> bool {
        matches!(self, AccumulatorError::Engine(EngineError::NoCellWithin))
    }
}
