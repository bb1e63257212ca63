//! Error of a message with invalid values.

use map::MapError;
use messages::FrameName;

/// A message that decodes, but has invalid values.
#[derive(Debug, thiserror::Error)]
pub enum ConversionError {
    #[error("the quaternion ({x}, {y}, {z}, {w}) is not a rotation; allowed: a length of 1")]
    Rotation { x: f64, y: f64, z: f64, w: f64 },
    #[error("the position ({x}, {y}) is not finite")]
    Position { x: f64, y: f64 },
    #[error("cell {index} is {found}; allowed: 0..=100, and -1 for unknown")]
    Cell { index: usize, found: i8 },
    #[error(
        "the frame {frame:?} has {} bytes, at most {} are allowed", frame.len(), FrameName::CAPACITY
    )]
    Frame { frame: String },
    #[error(
        "the point cloud has no usable field {field}: allowed is one float32 (7) or float64 (8) \
         within its points of {point_step} bytes; it has {found}"
    )]
    CloudField {
        field: &'static str,
        point_step: u32,
        found: String,
    },
    #[error(
        "the point cloud has {found} bytes: {height} rows of {width} points, {point_step} bytes a \
         point and {row_step} a row, do not fit"
    )]
    CloudSize {
        height: u32,
        width: u32,
        point_step: u32,
        row_step: u32,
        found: usize,
    },
    #[error(transparent)]
    Map(Box<MapError>),
}

impl From<MapError> for ConversionError {
    fn from(error: MapError) -> Self {
        ConversionError::Map(Box::new(error))
    }
}
