//! How large a picture may be.

use crate::DrawingError;

/// Most pixels along a side.
pub const MAX_SIDE: u32 = 16_384;

/// Whether a picture or an image may have these sides.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), DrawingError> {
    let allowed = 1..=MAX_SIDE;
    if allowed.contains(&width) && allowed.contains(&height) {
        return Ok(());
    }
    Err(DrawingError::Size { width, height })
}
