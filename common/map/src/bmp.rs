//! Decodes Windows bitmaps with the image library.
//!
//! The sizes in the header are checked against the crate's limits and the size of the file before
//! any memory is reserved for them.

use std::io::Cursor;
use std::path::Path;

use image::ImageDecoder;
use image::codecs::bmp::BmpDecoder;

use crate::MapError;
use crate::claim::{Claim, HEAD_BYTES, check_size, truncated};
use crate::raster::{Raster, Samples};

pub(crate) const SIGNATURE: &[u8] = b"BM";

/// Largest number of pixels encoded by two bytes of a packed bitmap.
const MAX_RUN: u64 = 255;

pub(crate) fn claim(head: &[u8], path: &Path) -> Result<Claim, MapError> {
    let Some(claims) = Claims::read(head) else {
        return Ok(Claim::NONE);
    };
    check_size(path, claims.width, claims.height)?;
    let pixels = (u64::from(claims.width) + 1) * u64::from(claims.height);
    Ok(Claim {
        sides: (claims.width, claims.height),
        most_bytes: pixels * 4 + HEAD_BYTES + claims.first_pixel.min(HEAD_BYTES),
    })
}

/// Decodes a file that starts with [`SIGNATURE`]; `path` is for errors.
pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Raster, MapError> {
    let damaged = MapError::damaged(path);
    if let Some(claims) = Claims::read(bytes) {
        claims.check(bytes, path)?;
    }
    let decoder = BmpDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    check_size(path, width, height)?;
    // RGB, also of palettes, or with alpha.
    let channels = usize::from(decoder.color_type().channel_count());
    // The sides are within the limits, so the product fits.
    let mut pixels = vec![0; width as usize * height as usize * channels];
    decoder.read_image(&mut pixels).map_err(damaged)?;
    Ok(Raster {
        width,
        height,
        channels,
        samples: Samples::Eight(pixels),
    })
}

/// Sizes in the header. Offsets are from the start of the file, all numbers are little-endian. The
/// short header of OS/2 has 12 bytes and sides of 16 bits (offsets and sizes in brackets); all
/// later ones begin like Windows' of 40 bytes:
///
/// | offset | bytes | field |
/// |---|---|---|
/// | 10 | 4 | offset of the pixels |
/// | 14 | 4 | size of the header that follows |
/// | 18 | 4 (2) | width |
/// | 22 (20) | 4 (2) | height; negative if the top row comes first |
/// | 28 (24) | 2 | bits per pixel |
/// | 30 (none) | 4 | 1 and 2: run-length encoding |
struct Claims {
    first_pixel: u64,
    width: u32,
    height: u32,
    bits: u64,
    is_packed: bool,
}

impl Claims {
    /// Returns `None` if the file is too short for a header; then the decoder returns the error.
    fn read(bytes: &[u8]) -> Option<Self> {
        let short = |at: usize| Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
        let long = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
        let first_pixel = u64::from(long(10)?);
        Some(match long(14)? {
            12 => Claims {
                first_pixel,
                width: short(18)?.into(),
                height: short(20)?.into(),
                bits: short(24)?.into(),
                is_packed: false,
            },
            _ => Claims {
                first_pixel,
                width: long(18)?,
                height: long(22)?.cast_signed().unsigned_abs(),
                bits: short(28)?.into(),
                is_packed: matches!(long(30)?, 1 | 2),
            },
        })
    }

    fn check(&self, bytes: &[u8], path: &Path) -> Result<(), MapError> {
        let (width, height) = (self.width, self.height);
        check_size(path, width, height)?;
        let needed = match self.is_packed {
            true => (u64::from(width) * u64::from(height) * 2).div_ceil(MAX_RUN),
            // Rows are padded to 32 bits.
            false => (u64::from(width) * self.bits).div_ceil(32) * 4 * u64::from(height),
        };
        let found = bytes.len().saturating_sub(self.first_pixel as usize);
        match (found as u64) < needed {
            true => Err(truncated(path, (width, height), needed, found)),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::Pixel;

    /// Creates a file with Windows' header of 40 bytes, followed by palette and pixels.
    fn file(
        width: i32,
        height: i32,
        bits: u16,
        packing: u32,
        palette: &[u8],
        rows: &[u8],
    ) -> Vec<u8> {
        let first = 54 + palette.len() as u32;
        let mut bytes = b"BM".to_vec();
        bytes.extend((first + rows.len() as u32).to_le_bytes());
        bytes.extend([0; 4]);
        bytes.extend(first.to_le_bytes());
        bytes.extend(40u32.to_le_bytes());
        bytes.extend(width.to_le_bytes());
        bytes.extend(height.to_le_bytes());
        bytes.extend(1u16.to_le_bytes());
        bytes.extend(bits.to_le_bytes());
        bytes.extend(packing.to_le_bytes());
        bytes.extend([0; 12]);
        bytes.extend((palette.len() as u32 / 4).to_le_bytes());
        bytes.extend([0; 4]);
        bytes.extend(palette);
        bytes.extend(rows);
        bytes
    }

    fn pixels(bytes: &[u8]) -> Result<Vec<Pixel>, MapError> {
        let raster = decode(bytes, Path::new("floor.bmp"))?;
        Ok((0..raster.height).flat_map(|y| raster.row(y)).collect())
    }

    fn reds(bytes: &[u8]) -> Vec<u16> {
        let pixels = pixels(bytes).unwrap();
        pixels.iter().map(|pixel| pixel.colour[0] / 257).collect()
    }

    /// Black, grey and white as blue, green, red and an unused byte.
    const GREYS: [u8; 12] = [0, 0, 0, 0, 205, 205, 205, 0, 254, 254, 254, 0];

    #[test]
    fn palettes_of_one_four_and_eight_bits_from_the_bottom_up() {
        let rows = [2, 1, 0, 0, 0, 1, 2, 0];
        assert_eq!(
            reds(&file(3, 2, 8, 0, &GREYS, &rows)),
            [0, 205, 254, 254, 205, 0]
        );
        let rows = [0x21, 0x00, 0, 0, 0x01, 0x20, 0, 0];
        assert_eq!(
            reds(&file(3, 2, 4, 0, &GREYS, &rows)),
            [0, 205, 254, 254, 205, 0]
        );
        let rows = [0b0110_0000, 0, 0, 0];
        assert_eq!(reds(&file(3, 1, 1, 0, &GREYS[..8], &rows)), [0, 205, 205]);
    }

    #[test]
    fn a_negative_height_has_its_top_row_first() {
        let rows = [0, 1, 2, 0, 2, 1, 0, 0];
        assert_eq!(
            reds(&file(3, -2, 8, 0, &GREYS, &rows)),
            [0, 205, 254, 254, 205, 0]
        );
    }

    #[test]
    fn colours_of_24_and_32_bits() {
        let [pixel] = pixels(&file(1, 1, 24, 0, &[], &[1, 2, 3, 0])).unwrap()[..] else {
            panic!("one pixel");
        };
        assert_eq!((pixel.colour, pixel.alpha), ([771, 514, 257], None));
        // The fourth byte is not opacity.
        let [pixel] = pixels(&file(1, 1, 32, 0, &[], &[1, 2, 3, 0])).unwrap()[..] else {
            panic!("one pixel");
        };
        assert_eq!((pixel.colour, pixel.alpha), ([771, 514, 257], None));
    }

    #[test]
    fn packed_rows_of_eight_bits() {
        // Two of colour 2, one of colour 1, end of row; three of colour 0, end.
        let rows = [2, 2, 1, 1, 0, 0, 3, 0, 0, 1];
        assert_eq!(
            reds(&file(3, 2, 8, 1, &GREYS, &rows)),
            [0, 0, 0, 254, 254, 205]
        );
    }

    #[test]
    fn the_short_header_of_os2() {
        let mut bytes = b"BM\0\0\0\0\0\0\0\0".to_vec();
        bytes.extend(32u32.to_le_bytes());
        bytes.extend(12u32.to_le_bytes());
        for number in [2u16, 1, 1, 1] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0, 0, 254, 254, 254]);
        bytes.extend([0b0100_0000, 0, 0, 0]);
        assert_eq!(reds(&bytes), [0, 254]);
        assert!(
            pixels(&bytes[..35])
                .unwrap_err()
                .to_string()
                .contains("cut short")
        );
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let rows: Vec<u8> = (0..64 * 48u32).map(|i| (i % 3) as u8).collect();
        let whole = file(64, 48, 8, 0, &GREYS, &rows);
        assert_eq!(reds(&whole).len(), 64 * 48);
        for length in 0..whole.len() {
            assert!(pixels(&whole[..length]).is_err(), "cut at {length}");
        }
        assert_eq!(
            pixels(&whole[..whole.len() - 1]).unwrap_err().to_string(),
            "floor.bmp is cut short: 64 x 48 cells need at least 3072 bytes, 3071 are there"
        );
    }

    #[test]
    fn absurd_sizes_are_refused_before_anything_is_reserved() {
        let refusal = |width, height, bits, packing| {
            let bytes = file(width, height, bits, packing, &GREYS, &[0; 16]);
            pixels(&bytes).unwrap_err().to_string()
        };
        assert_eq!(
            refusal(31_623, 31_623, 8, 0),
            "floor.bmp claims 31623 x 31623 cells; allowed: sides of 1..=32767 and at most 400000000 cells"
        );
        for (width, height) in [(0, 1), (1, 0), (-1, 1), (i32::MAX, i32::MIN), (1, i32::MIN)] {
            assert!(
                refusal(width, height, 8, 0).contains("claims"),
                "{width} {height}"
            );
        }
        // Allowed, but the pixels are missing.
        assert!(refusal(16_384, 16_384, 32, 0).contains("cut short"));
        assert!(refusal(16_384, -16_384, 1, 0).contains("cut short"));
        // Packed, but even the longest runs would not fill it.
        assert!(refusal(16_384, 16_384, 8, 1).contains("cut short"));
        assert!(refusal(16_384, 16_384, 4, 2).contains("cut short"));
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(
            start in proptest::collection::vec(proptest::num::u8::ANY, 0..60),
            (width, height) in (0i32..9, -9i32..9),
            (bits, packing) in (proptest::sample::select(vec![0u16, 1, 2, 4, 8, 16, 24, 32, 65_535]), 0u32..8),
            rows in proptest::collection::vec(proptest::num::u8::ANY, 0..400),
        ) {
            let _ = pixels(&[SIGNATURE, &start].concat());
            if let Ok(pixels) = pixels(&file(width, height, bits, packing, &GREYS, &rows)) {
                proptest::prop_assert_eq!(pixels.len() as u32, width as u32 * height.unsigned_abs());
            }
        }
    }
}
