//! Raster images within a picture.

use std::io;

use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::size::check_size;
use crate::{Color, DrawingError};

/// Pixels, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    /// Red, green, blue and opacity of each pixel, not premultiplied.
    rgba: Vec<u8>,
}

impl Image {
    /// Creates an image of `width · height` pixels from a colour for each column and row.
    ///
    /// # Errors
    /// A side is 0 or above [`MAX_SIDE`](crate::MAX_SIDE).
    pub fn from_pixels(
        width: u32,
        height: u32,
        mut color: impl FnMut(u32, u32) -> Color,
    ) -> Result<Self, DrawingError> {
        check_size(width, height)?;
        let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let color = color(x, y);
                let opacity = (255.0 * color.opacity).round() as u8;
                rgba.extend([color.red, color.green, color.blue, opacity]);
            }
        }
        Image::new(width, height, rgba)
    }

    /// Creates an image from red, green, blue and opacity of each pixel.
    ///
    /// # Errors
    /// A side is out of range, or there are not four bytes per pixel.
    pub fn new(width: u32, height: u32, rgba: Vec<u8>) -> Result<Self, DrawingError> {
        check_size(width, height)?;
        if rgba.len() != 4 * width as usize * height as usize {
            return Err(DrawingError::Pixels {
                width,
                height,
                found: rgba.len(),
            });
        }
        Ok(Image {
            width,
            height,
            rgba,
        })
    }

    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Red, green, blue and opacity of each pixel.
    #[must_use]
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    /// Red, green, blue and opacity of one pixel; all 0 outside the image.
    pub(crate) fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        let first = 4 * (y as usize * self.width as usize + x as usize);
        let pixel = self.rgba.get(first..).and_then(<[u8]>::first_chunk);
        pixel.copied().unwrap_or_default()
    }

    /// Encodes a PNG file.
    ///
    /// # Errors
    /// The encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, DrawingError> {
        // Opaque images, the usual case, need no fourth channel.
        let is_opaque = self.rgba.iter().skip(3).step_by(4).all(|&a| a == 255);
        if !is_opaque {
            return encode(self.width, self.height, ColorType::Rgba, &self.rgba);
        }
        let pixels = self.rgba.chunks_exact(4);
        let rgb: Vec<u8> = pixels
            .flat_map(|pixel| pixel.iter().copied().take(3))
            .collect();
        encode(self.width, self.height, ColorType::Rgb, &rgb)
    }
}

fn encode(
    width: u32,
    height: u32,
    color: ColorType,
    pixels: &[u8],
) -> Result<Vec<u8>, DrawingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(io::Cursor::new(&mut bytes), width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    // Areas of one colour compress best without a filter.
    encoder.set_filter(Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Size and bytes of a PNG file, and number of bytes per pixel.
    pub(crate) fn decode(bytes: &[u8]) -> ((u32, u32), Vec<u8>, usize) {
        let mut reader = png::Decoder::new(io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        ((info.width, info.height), pixels, info.color_type.samples())
    }

    #[test]
    fn pixels_come_back_from_png() {
        let colors = [Color::rgb(0x10_2030), Color::rgb(0xFF_0000)];
        let opaque = Image::from_pixels(2, 1, |x, _| colors[x as usize]).unwrap();
        let (size, pixels, samples) = decode(&opaque.to_png().unwrap());
        assert_eq!((size, samples), ((2, 1), 3));
        assert_eq!(pixels, [0x10, 0x20, 0x30, 0xFF, 0, 0]);

        let half = Image::from_pixels(1, 2, |_, y| colors[y as usize].with_opacity(0.5)).unwrap();
        let (size, pixels, samples) = decode(&half.to_png().unwrap());
        assert_eq!((size, samples), ((1, 2), 4));
        assert_eq!(pixels, [0x10, 0x20, 0x30, 128, 0xFF, 0, 0, 128]);
    }

    #[test]
    fn sides_and_bytes_must_agree() {
        let error = Image::new(2, 3, vec![0; 23]).unwrap_err().to_string();
        let expected = "an image of 2 x 3 pixels came with 23 bytes; four a pixel are needed";
        assert_eq!(error, expected);
        assert!(Image::new(0, 3, Vec::new()).is_err());
    }
}
