//! Errors that reject a scan or a map, or stop the node.

use engine::EngineError;
use engine::heading::HeadingError;
use transport::TransportError;

/// Rejected scan or map, or failure of the node.
#[derive(Debug, thiserror::Error)]
pub enum AccumulatorError {
    #[error("a search is asked for, but the scan is not among the last 64, or was searched")]
    NotKept,
    #[error("there is no map yet")]
    NoMap,
    /// The scan, the map or a setting cannot be used.
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
    /// The scan has too many readings for a ring of sonars.
    #[error(
        "the scan has {found} readings: a ring of sonars, as which it is to be read, has at most \
         {allowed}"
    )]
    TooManyEchoes {
        /// Number of readings found.
        found: usize,
        /// Largest number accepted.
        allowed: usize,
    },
    #[error("the boundary came with {found} cells instead of {expected}")]
    BoundarySize {
        /// Number according to the header.
        expected: u64,
        /// Number received.
        found: usize,
    },
    #[error("cannot start a thread to prepare map {map_id:016x}")]
    Thread {
        /// Id of the map.
        map_id: u64,
        /// Error of the operating system.
        source: std::io::Error,
    },
    #[error("preparing map {map_id:016x} died: {reason}")]
    PreparationDied {
        /// Id of the map.
        map_id: u64,
        /// Message of the panic.
        reason: String,
    },
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl AccumulatorError {
    /// Returns true if the error is that no pose of the map is allowed by the search region.
    pub(crate) fn leaves_no_pose(&self) -> bool {
        matches!(self, AccumulatorError::Engine(EngineError::NoCellWithin))
    }
}
