//! Errors of creating a picture.

use crate::drawing::MAX_SIDE;

#[derive(Debug, thiserror::Error)]
pub enum DrawingError {
    /// A side of the picture is 0 or too large.
    #[error("a picture of {width} x {height} pixels; allowed: 1 to {MAX_SIDE} along each side")]
    Size { width: u32, height: u32 },
    #[error("an animation needs at least one picture")]
    NoFrame,
    /// A frame of an animation differs in size from the first one.
    #[error("a picture of {width} x {height} pixels in an animation of another size")]
    FrameSize { width: u32, height: u32 },
    #[error("the picture cannot be encoded as PNG")]
    Encoding(#[from] png::EncodingError),
    #[error("the picture cannot be rendered")]
    Rendering(#[from] resvg::usvg::Error),
}
