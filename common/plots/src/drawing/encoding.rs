//! Encodes pixels as PNG.

use std::io::{Cursor, Write};

use anyhow::bail;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

/// Maximum number of pixels per side.
pub(super) const MAX_SIDE: u32 = 16_384;

/// Message of all errors of the encoder.
pub(super) const NOT_ENCODED: &str = "the picture cannot be encoded as PNG";

/// Checks that a picture or an image may have these sides.
pub(super) fn check_size(width: u32, height: u32) -> anyhow::Result<()> {
    let allowed = 1..=MAX_SIDE;
    if allowed.contains(&width) && allowed.contains(&height) {
        return Ok(());
    }
    bail!("a picture of {width} x {height} pixels; allowed: 1 to {MAX_SIDE} along each side")
}

/// Encodes red, green and blue of each pixel, row by row from the top.
pub(crate) fn encoded(sides: (u32, u32), rgb: &[u8]) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let encoder = encoder(Cursor::new(&mut bytes), sides, ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(bytes)
}

pub(crate) fn encoder<W: Write>(
    to: W,
    (width, height): (u32, u32),
    color: ColorType,
) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(to, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    // Areas of one colour compress best without a filter.
    encoder.set_filter(Filter::NoFilter);
    encoder
}
