//! Encodes pixels as PNG.

use std::io::{Cursor, Write};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

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
