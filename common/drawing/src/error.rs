//! Errors of a picture.

use crate::MAX_SIDE;

/// Why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum DrawingError {
    /// A picture without a pixel, or with too many.
    #[error("a picture of {width} x {height} pixels; allowed: 1 to {MAX_SIDE} along each side")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// An image whose pixels are not as many as its sides say.
    #[error(
        "an image of {width} x {height} pixels came with {found} bytes; four a pixel are needed"
    )]
    Pixels {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Bytes that there are.
        found: usize,
    },
    /// An animation without a picture.
    #[error("an animation needs at least one picture")]
    NoFrame,
    /// A picture of an animation that is not as large as the first.
    #[error("a picture of {width} x {height} pixels in an animation of another size")]
    FrameSize {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The pixels could not be encoded.
    #[error("the picture cannot be encoded as PNG")]
    Encoding(#[from] png::EncodingError),
}
