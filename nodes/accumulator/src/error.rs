//! Errors that reject a scan or a map, and the node
//! from running.

use engine::EngineError;
use engine::heading::HeadingError;
use messages::BoundaryCell;
use transport::TransportError;

/// A scan or a map that is refused, or a failure of the node.
#[derive(Debug, thiserror::Error)]
pub enum AccumulatorError {
    /// A search is asked for of a scan that is not kept.
    #[error("a search is asked for, but the scan is not among the last 64, or was searched")]
    NotKept,
    /// The scan came before a map was ready.
    #[error("there is no map yet")]
    NoMap,
    /// The scan, the map or a setting cannot be used.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The map is not the one that its id says.
    #[error(transparent)]
    MapId(#[from] messages::WrongMapId),
    /// The set of maps is none.
    #[error(transparent)]
    MapSet(#[from] messages::InvalidMapSet),
    /// The map has an impossible rule for its cells.
    #[error(transparent)]
    Rule(#[from] messages::InvalidRule),
    /// The scan's heading is not known.
    #[error(transparent)]
    Heading(#[from] HeadingError),
    /// The boundary has another size than it says.
    #[error("the boundary came with {found} cells instead of {expected}")]
    BoundarySize {
        /// By its header.
        expected: u64,
        /// That came.
        found: usize,
    },
    /// A cell of the boundary is none of the map's obstacles.
    #[error("cell {}, {} of the boundary is not an occupied cell of the map", cell.x, cell.y)]
    BoundaryCell {
        /// As the boundary has it.
        cell: BoundaryCell,
    },
    /// The cells of the boundary are not in order.
    #[error(
        "cell {}, {} of the boundary follows {}, {}: they must rise by (y, x)",
        cell.x, cell.y, previous.x, previous.y
    )]
    BoundaryOrder {
        /// The one before.
        previous: BoundaryCell,
        /// As the boundary has it.
        cell: BoundaryCell,
    },
    /// No thread could be started to prepare a map.
    #[error("cannot start a thread to prepare map {map_id:016x}")]
    Thread {
        /// The map.
        map_id: u64,
        /// What the system says.
        source: std::io::Error,
    },
    /// The thread that prepared a map has panicked.
    #[error("preparing map {map_id:016x} died: {reason}")]
    PreparationDied {
        /// The map.
        map_id: u64,
        /// The panic's message.
        reason: String,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

impl AccumulatorError {
    /// Whether no pose of the map is left where poses are to be searched.
    pub(crate) fn leaves_no_pose(&self) -> bool {
        matches!(self, AccumulatorError::Engine(EngineError::NoCellWithin))
    }
}
