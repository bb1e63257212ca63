//! Error of a message with invalid values.

use map::MapError;
use messages::FrameName;

/// A message that decodes, but has invalid values.
#[derive(Debug, thiserror::Error)]
pub enum ConversionError {
    /// A quaternion that is no rotation: its length is not 1 within a few percent, or it is not
    /// finite.
    #[error("the quaternion ({x}, {y}, {z}, {w}) is not a rotation; allowed: a length of 1")]
    Rotation {
        x: f64,
        y: f64,
        z: f64,
        /// Real part.
        w: f64,
    },
    /// A position that is not finite.
    #[error("the position ({x}, {y}) is not finite")]
    Position {
        /// X, in metres.
        x: f64,
        /// Y, in metres.
        y: f64,
    },
    /// An occupancy out of range.
    #[error("cell {index} is {found}; allowed: 0..=100, and -1 for unknown")]
    Cell {
        /// Index of the cell, row by row from the lowest y.
        index: usize,
        found: i8,
    },
    /// The name of a frame is too long for a message of the graph.
    #[error(
        "the frame {frame:?} has {} bytes, at most {} are allowed", frame.len(), FrameName::CAPACITY
    )]
    Frame {
        /// Name of the frame.
        frame: String,
    },
    /// A point cloud without a usable coordinate.
    #[error(
        "the point cloud has no usable field {field}: allowed is one float32 (7) or float64 (8) \
         within its points of {point_step} bytes; it has {found}"
    )]
    CloudField {
        /// `x`, `y` or `z`.
        field: &'static str,
        /// Size of a point, in bytes.
        point_step: u32,
        /// Fields of the cloud, with datatype, count and offset.
        found: String,
    },
    /// A point cloud with fewer bytes than its sizes say, or with rows that overlap.
    #[error(
        "the point cloud has {found} bytes: {height} rows of {width} points, {point_step} bytes a \
         point and {row_step} a row, do not fit"
    )]
    CloudSize {
        height: u32,
        width: u32,
        /// Size of a point, in bytes.
        point_step: u32,
        /// Size of a row, in bytes.
        row_step: u32,
        /// Number of bytes of the data.
        found: usize,
    },
    /// A map that exceeds the limits.
    #[error(transparent)]
    Map(Box<MapError>),
}

impl From<MapError> for ConversionError {
    fn from(error: MapError) -> Self {
        ConversionError::Map(Box::new(error))
    }
}
