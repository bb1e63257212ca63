//! Why a message's numbers are not what they should be.

use map::MapError;
use messages::FrameName;

/// A message that decodes, but says something that cannot be.
#[derive(Debug, thiserror::Error)]
pub enum ConversionError {
    /// A quaternion that is no rotation: its length is not 1 within a few percent,
    /// or it is not a number.
    #[error("the quaternion ({x}, {y}, {z}, {w}) is not a rotation; allowed: a length of 1")]
    Rotation {
        /// Of i.
        x: f64,
        /// Of j.
        y: f64,
        /// Of k.
        z: f64,
        /// The real part.
        w: f64,
    },
    /// A position that is not a number.
    #[error("the position ({x}, {y}) is not finite")]
    Position {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// An occupancy out of range.
    #[error("cell {index} is {found}; allowed: 0..=100, and -1 for unknown")]
    Cell {
        /// Index of the cell, row by row from the lowest y.
        index: usize,
        /// Its occupancy.
        found: i8,
    },
    /// A frame's name does not fit into a message of the graph.
    #[error(
        "the frame {frame:?} has {} bytes, at most {} are allowed", frame.len(), FrameName::CAPACITY
    )]
    Frame {
        /// The name.
        frame: String,
    },
    /// A map that is not within the limits.
    #[error(transparent)]
    Map(Box<MapError>),
}

impl From<MapError> for ConversionError {
    fn from(error: MapError) -> Self {
        ConversionError::Map(Box::new(error))
    }
}
