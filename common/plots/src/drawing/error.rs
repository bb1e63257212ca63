//! Errors of creating a picture, and the limits of its size.

/// Maximum number of pixels per side.
pub const MAX_SIDE: u32 = 16_384;

/// Checks that a picture or an image may have these sides.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), DrawingError> {
    let allowed = 1..=MAX_SIDE;
    if allowed.contains(&width) && allowed.contains(&height) {
        return Ok(());
    }
    Err(DrawingError::Size { width, height })
}

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
