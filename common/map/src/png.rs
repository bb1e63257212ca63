//! Decodes PNG images with the image library.
//!
//! The sizes in the header are checked against the crate's limits, and against the largest content
//! of that many compressed bytes, before any memory is reserved for them.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::PngDecoder;
use image::{ImageDecoder, Limits};

use crate::claim::{Claim, check_size, truncated};
use crate::raster::{Raster, Samples};
use crate::{MAX_SIDE, MapError};

pub(crate) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Last chunk of every such file: its length, name and checksum.
const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";

/// Highest compression ratio of deflate: 258 bytes for a length and a distance of one bit each.
const MAX_RATIO: u64 = 1032;

/// Largest memory of the decoder in bytes, apart from the pixels.
const DECODER_BYTES: u64 = 64 << 20;

/// Largest size of other chunks in a file in bytes, e.g. colour profiles.
const BESIDE_BYTES: u64 = 16 << 20;

/// Reads the header of a file that begins with `head`; its pixels may be incompressible.
pub(crate) fn claim(head: &[u8], path: &Path) -> Result<Claim, MapError> {
    let Some((width, height)) = sides(head) else {
        return Ok(Claim::NONE);
    };
    check_size(path, width, height)?;
    // Four samples of two bytes each, and a filter byte for each row.
    let pixels = (u64::from(width) * 8 + 1) * u64::from(height);
    Ok(Claim {
        sides: (width, height),
        most_bytes: pixels + BESIDE_BYTES,
    })
}

pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Raster, MapError> {
    let damaged = MapError::damaged(path);
    check_claims(bytes, path)?;
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(DECODER_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    // The decoder expands palettes, and samples of fewer than eight bits.
    let colour = decoder.color_type();
    let channels = usize::from(colour.channel_count());
    // The sides are within the limits, so the product fits.
    let count = width as usize * height as usize * channels;
    let samples = if colour.bytes_per_pixel() > colour.channel_count() {
        let mut samples = vec![0; count];
        let mut pixels = vec![0; 2 * count];
        decoder.read_image(&mut pixels).map_err(damaged)?;
        for (sample, pair) in samples.iter_mut().zip(pixels.as_chunks::<2>().0) {
            *sample = u16::from_ne_bytes(*pair);
        }
        Samples::Sixteen(samples)
    } else {
        let mut pixels = vec![0; count];
        decoder.read_image(&mut pixels).map_err(damaged)?;
        Samples::Eight(pixels)
    };
    check_end(bytes, path, (width, height))?;
    Ok(Raster {
        width,
        height,
        channels,
        samples,
    })
}

/// Returns width and height in the header; `None` if it is cut off.
fn sides(head: &[u8]) -> Option<(u32, u32)> {
    let side = |at: usize| Some(u32::from_be_bytes(*head.get(at..)?.first_chunk()?));
    Some((side(16)?, side(20)?))
}

/// Checks the sizes in the first chunk. Its fields, by offset from the start of the file:
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 8 | 8 | length and name of the chunk, `IHDR` |
/// | 16 | 4 | width, big-endian |
/// | 20 | 4 | height |
/// | 24 | 1 | bits per sample |
/// | 25 | 1 | colour type: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA |
fn check_claims(bytes: &[u8], path: &Path) -> Result<(), MapError> {
    let (Some((width, height)), Some(&bits), Some(&colour)) =
        (sides(bytes), bytes.get(24), bytes.get(25))
    else {
        // Too short for a header: the decoder returns the error.
        return Ok(());
    };
    check_size(path, width, height)?;
    let samples = match colour {
        2 => 3,
        4 => 2,
        6 => 4,
        _ => 1,
    };
    let row = (u64::from(width) * samples * u64::from(bits)).div_ceil(8);
    let needed = (row * u64::from(height)).div_ceil(MAX_RATIO);
    if needed > bytes.len() as u64 {
        return Err(truncated(path, (width, height), needed, bytes.len()));
    }
    Ok(())
}

/// Checks that the file has its last chunk. The decoder stops at the last pixel; a cut file may
/// lack the checksum of the pixels.
fn check_end(bytes: &[u8], path: &Path, sides: (u32, u32)) -> Result<(), MapError> {
    if bytes.windows(END.len()).rev().any(|window| window == END) {
        return Ok(());
    }
    let needed = bytes.len() as u64 + 1;
    Err(truncated(path, sides, needed, bytes.len()))
}

#[cfg(test)]
mod tests {
    use ::png::{BitDepth, ColorType as Colour};

    use super::*;
    use crate::raster::Pixel;

    /// Creates a file of `rows` in the format's own layout, with an optional palette and its
    /// transparency.
    fn file(
        (width, height): (u32, u32),
        colour: Colour,
        depth: BitDepth,
        palette: Option<(&[u8], &[u8])>,
        rows: &[u8],
    ) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if let Some((colours, transparency)) = palette {
            encoder.set_palette(colours.to_vec());
            encoder.set_trns(transparency.to_vec());
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(rows).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn pixels(bytes: &[u8]) -> Result<Vec<Pixel>, MapError> {
        let raster = decode(bytes, Path::new("floor.png"))?;
        Ok((0..raster.height).flat_map(|y| raster.row(y)).collect())
    }

    fn greys(bytes: &[u8]) -> Vec<u16> {
        let pixels = pixels(bytes).unwrap();
        pixels.iter().map(|pixel| pixel.colour[0]).collect()
    }

    #[test]
    fn grey_of_one_to_sixteen_bits() {
        let grey = |depth, rows: &[u8]| greys(&file((2, 1), Colour::Grayscale, depth, None, rows));
        assert_eq!(grey(BitDepth::One, &[0b0100_0000]), [0, 65_535]);
        assert_eq!(grey(BitDepth::Two, &[0b0111_0000]), [85 * 257, 65_535]);
        assert_eq!(grey(BitDepth::Four, &[0x1f]), [17 * 257, 65_535]);
        assert_eq!(grey(BitDepth::Eight, &[1, 254]), [257, 65_278]);
        assert_eq!(
            grey(BitDepth::Sixteen, &[0x12, 0x34, 0xff, 0xfe]),
            [0x1234, 0xfffe]
        );
    }

    #[test]
    fn colour_and_alpha() {
        let of = |colour, depth, rows: &[u8]| {
            pixels(&file((1, 1), colour, depth, None, rows)).unwrap()[0]
        };
        let grey = of(Colour::GrayscaleAlpha, BitDepth::Eight, &[10, 20]);
        assert_eq!(grey.colour, [2570; 3]);
        assert_eq!(grey.alpha, Some(5140));
        let rgb = of(Colour::Rgb, BitDepth::Eight, &[1, 2, 3]);
        assert_eq!((rgb.colour, rgb.alpha), ([257, 514, 771], None));
        let rgba = of(Colour::Rgba, BitDepth::Sixteen, &[0, 1, 0, 2, 0, 3, 0, 4]);
        assert_eq!((rgba.colour, rgba.alpha), ([1, 2, 3], Some(4)));
    }

    #[test]
    fn palettes_with_transparent_entries() {
        let colours = [255, 0, 0, 10, 10, 10];
        let bytes = file(
            (2, 1),
            Colour::Indexed,
            BitDepth::One,
            Some((&colours, &[0])),
            &[0b1000_0000],
        );
        let pixels = pixels(&bytes).unwrap();
        assert_eq!(
            (pixels[0].colour, pixels[0].alpha),
            ([2570; 3], Some(65_535))
        );
        assert_eq!(
            (pixels[1].colour, pixels[1].alpha),
            ([65_535, 0, 0], Some(0))
        );
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let rows: Vec<u8> = (0..64 * 48u32).map(|i| (i * i / 8) as u8).collect();
        let whole = file((64, 48), Colour::Grayscale, BitDepth::Eight, None, &rows);
        assert!(pixels(&whole).is_ok());
        for length in 0..whole.len() {
            assert!(pixels(&whole[..length]).is_err(), "cut at {length}");
        }
    }

    #[test]
    fn absurd_sizes_are_refused_before_anything_is_reserved() {
        let mut bytes = file((1, 1), Colour::Grayscale, BitDepth::Eight, None, &[0]);
        let mut claim = |width: u32, height: u32| {
            bytes[16..20].copy_from_slice(&width.to_be_bytes());
            bytes[20..24].copy_from_slice(&height.to_be_bytes());
            pixels(&bytes).unwrap_err().to_string()
        };
        assert!(claim(31_623, 31_623).contains("claims 31623 x 31623 cells"));
        assert!(claim(0, 1).contains("claims 0 x 1 cells"));
        assert!(claim(u32::MAX, u32::MAX).contains("claims"));
        // Allowed, but deflate cannot compress that much into so few bytes.
        assert!(claim(16_384, 16_384).contains("cut short"));
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(body in proptest::collection::vec(proptest::num::u8::ANY, 0..200)) {
            let _ = pixels(&[SIGNATURE, &body].concat());
        }

        #[test]
        fn a_flipped_bit_makes_no_other_picture(at in 0usize..2000, bit in 0u8..8) {
            let rows: Vec<u8> = (0..32 * 32u32).map(|i| (i * 37 / 4) as u8).collect();
            let whole = file((32, 32), Colour::Grayscale, BitDepth::Eight, None, &rows);
            let mut flipped = whole.clone();
            let at = at % flipped.len();
            flipped[at] ^= 1 << bit;
            if let Ok(pixels) = pixels(&flipped) {
                let greys: Vec<u16> = pixels.iter().map(|pixel| pixel.colour[0]).collect();
                proptest::prop_assert_eq!(greys, super::tests::greys(&whole));
            }
        }
    }
}
