//! Limits of the size of a picture.

use crate::drawing::DrawingError;

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
