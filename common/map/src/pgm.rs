//! Decodes portable grey maps: the header with the image library, the pixels here.
//!
//! The library scales pixels to eight bits, reserves the size in the header and accepts values
//! above the header's maximum. Here pixels keep their precision, and memory is allocated only for
//! existing pixels.
//!
//! | field | P2 | P5 |
//! |---|---|---|
//! | header | `P2`, width, height, highest value | `P5`, the same |
//! | pixel | decimal number, white space | one byte; two, high first, above 255 |

use std::io::Cursor;
use std::path::Path;

use image::codecs::pnm::{GraymapHeader, PnmDecoder, PnmHeader, SampleEncoding};

use crate::MapError;
use crate::claim::{Claim, HEAD_BYTES, check_size, truncated, wrong_kind};
use crate::raster::{FULL, Raster, Samples};

pub(crate) fn claim(head: &[u8], path: &Path) -> Result<Claim, MapError> {
    let (_, header) = read_header(head, path)?;
    let pixel = match header.as_graymap() {
        Some(grey) if header.subtype().sample_encoding() == SampleEncoding::Binary => {
            1 + u64::from(grey.maxwhite > 255)
        }
        // Up to five digits, and white space to align columns.
        _ => 8,
    };
    let pixels = u64::from(header.width()) * u64::from(header.height());
    Ok(Claim {
        sides: (header.width(), header.height()),
        most_bytes: pixels * pixel + HEAD_BYTES,
    })
}

/// Reads the header, checks its sides, and returns it with the offset of the pixels.
fn read_header(bytes: &[u8], path: &Path) -> Result<(usize, PnmHeader), MapError> {
    let (cursor, header) = PnmDecoder::new(Cursor::new(bytes))
        .map_err(MapError::damaged(path))?
        .into_inner();
    check_size(path, header.width(), header.height())?;
    let start = usize::try_from(cursor.position()).unwrap_or(usize::MAX);
    Ok((start, header))
}

pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Raster, MapError> {
    let (start, header) = read_header(bytes, path)?;
    let Some(header) = header.as_graymap() else {
        return Err(wrong_kind(bytes, path));
    };
    let pixels = Pixels {
        header,
        bytes: bytes.get(start..).unwrap_or_default(),
        path,
    };
    Ok(Raster {
        width: header.width,
        height: header.height,
        channels: 1,
        samples: match header.encoding {
            SampleEncoding::Binary => pixels.binary()?,
            SampleEncoding::Ascii => pixels.plain()?,
        },
    })
}

struct Pixels<'a> {
    header: &'a GraymapHeader,
    bytes: &'a [u8],
    path: &'a Path,
}

impl Pixels<'_> {
    /// Returns the number of pixels. The sides are within the limits, so the product fits.
    fn count(&self) -> usize {
        self.header.width as usize * self.header.height as usize
    }

    fn binary(&self) -> Result<Samples, MapError> {
        let width = if self.header.maxwhite > 255 { 2 } else { 1 };
        let (pixels, rest) = self
            .bytes
            .split_at_checked(self.count() * width)
            .ok_or_else(|| self.truncated(self.count() * width))?;
        if !rest.iter().all(u8::is_ascii_whitespace) {
            return Err(self.surplus(rest.len()));
        }
        if self.header.maxwhite == 255 {
            return Ok(Samples::Eight(pixels.to_vec()));
        }
        let value = |pixel: &[u8]| {
            pixel
                .iter()
                .fold(0, |high, &low| high << 8 | u32::from(low))
        };
        let samples = pixels.chunks_exact(width).map(value).enumerate();
        samples
            .map(|(index, value)| self.scaled(index, value))
            .collect::<Result<_, _>>()
            .map(Samples::Sixteen)
    }

    fn plain(&self) -> Result<Samples, MapError> {
        // Each pixel has at least a digit, and white space before the next one.
        let needed = 2 * self.count() - 1;
        if self.bytes.len() < needed {
            return Err(self.truncated(needed));
        }
        let mut words = self
            .bytes
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        let mut samples = Vec::with_capacity(self.count());
        for index in 0..self.count() {
            let word = words.next().ok_or_else(|| self.truncated(needed))?;
            samples.push(self.scaled(index, self.number(index, word)?)?);
        }
        match words.next() {
            None => Ok(Samples::Sixteen(samples)),
            Some(word) => Err(self.surplus(word.len())),
        }
    }

    fn number(&self, index: usize, word: &[u8]) -> Result<u32, MapError> {
        let text = std::str::from_utf8(word).unwrap_or_default();
        text.parse().map_err(|_| {
            let shown = String::from_utf8_lossy(&word[..word.len().min(16)]);
            self.bad_pixel(index, &shown)
        })
    }

    /// Scales a value to 16 bits, rounding half up.
    fn scaled(&self, index: usize, value: u32) -> Result<u16, MapError> {
        let highest = self.header.maxwhite;
        if value > highest {
            return Err(self.bad_pixel(index, &value.to_string()));
        }
        let full = u64::from(FULL);
        let scaled = (u64::from(value) * full + u64::from(highest) / 2) / u64::from(highest);
        // At most FULL, because the value is at most the maximum.
        Ok(scaled as u16)
    }

    fn bad_pixel(&self, index: usize, found: &str) -> MapError {
        let width = self.header.width as usize;
        let (x, y, allowed) = (index % width, index / width, self.header.maxwhite);
        MapError::Invalid(format!(
            "{}: pixel {x}, {y} from the top left is {found}; allowed: 0..={allowed}",
            self.path.display()
        ))
    }

    fn truncated(&self, needed: usize) -> MapError {
        let sides = (self.header.width, self.header.height);
        truncated(self.path, sides, needed as u64, self.bytes.len())
    }

    fn surplus(&self, bytes: usize) -> MapError {
        let (width, height) = (self.header.width, self.header.height);
        MapError::invalid(
            self.path,
            format!(
                "goes on for {bytes} bytes after the last of {width} x {height} cells; allowed: \
                 white space"
            ),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(bytes: &[u8]) -> Result<Vec<u16>, MapError> {
        let raster = decode(bytes, Path::new("floor.pgm"))?;
        let rows = (0..raster.height).flat_map(|y| raster.row(y).map(|pixel| pixel.colour[0]));
        Ok(rows.collect())
    }

    fn refusal(bytes: &[u8]) -> String {
        samples(bytes).unwrap_err().to_string()
    }

    #[test]
    fn binary_pixels_of_one_and_two_bytes() {
        assert_eq!(
            samples(b"P5\n# drawn by hand\n3 1\n255\n\x00\x01\xff").unwrap(),
            [0, 257, 65_535]
        );
        assert_eq!(
            samples(b"P5 2 1 65535\n\x12\x34\xff\xff").unwrap(),
            [0x1234, 65_535]
        );
        // Other maxima are scaled: half of 100, and 300 of 600.
        assert_eq!(samples(b"P5 2 1 100\n\x32\x64").unwrap(), [32_768, 65_535]);
        assert_eq!(samples(b"P5 1 1 600\n\x01\x2c\n").unwrap(), [32_768]);
    }

    #[test]
    fn plain_pixels() {
        assert_eq!(
            samples(b"P2\n2 2\n255\n0 1\n 254\t255\n").unwrap(),
            [0, 257, 65_278, 65_535]
        );
        assert_eq!(samples(b"P2 1 1 65535 4660").unwrap(), [0x1234]);
    }

    #[test]
    fn cut_and_overlong_files_are_refused() {
        assert_eq!(
            refusal(b"P5 3 2 255\n12345"),
            "floor.pgm is cut short: 3 x 2 cells need at least 6 bytes, 5 are there"
        );
        assert_eq!(
            refusal(b"P2 3 1 255 1 2 "),
            "floor.pgm is cut short: 3 x 1 cells need at least 5 bytes, 4 are there"
        );
        assert!(refusal(b"P2 2 1 2000 1234 ").contains("cut short"));
        assert_eq!(
            refusal(b"P5 3 2 255\n1234567"),
            "floor.pgm goes on for 1 bytes after the last of 3 x 2 cells; allowed: white space"
        );
        assert!(refusal(b"P2 1 1 255 1 2").contains("goes on"));
        for cut in [&b"P5"[..], b"P5 3", b"P5 3 2 ", b"P2\n#"] {
            assert!(refusal(cut).contains("damaged or cut short"), "{cut:?}");
        }
    }

    #[test]
    fn pixels_out_of_range_are_named() {
        assert_eq!(
            refusal(b"P5 2 2 100\n\x01\x02\x03\x65"),
            "floor.pgm: pixel 1, 1 from the top left is 101; allowed: 0..=100"
        );
        assert_eq!(
            refusal(b"P2 2 1 255 7 -1 "),
            "floor.pgm: pixel 1, 0 from the top left is -1; allowed: 0..=255"
        );
    }

    #[test]
    fn absurd_sizes_are_refused_before_anything_is_reserved() {
        assert!(refusal(b"P5 31623 31623 255\n").contains("claims 31623 x 31623 cells"));
        for header in ["P5 0 3 255\n", "P2 3 0 255\n", "P5 32768 1 255\n"] {
            assert!(refusal(header.as_bytes()).contains("claims"), "{header}");
        }
        // Within the limits, but the pixels are missing.
        assert!(refusal(b"P5 16384 16384 65535\n").contains("cut short"));
        for header in ["P5 3 2 0\n", "P5 3 2 65536\n", "P5 99999999999 2 255\n"] {
            assert!(samples(header.as_bytes()).is_err(), "{header}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(
            kind in "[PQ][1-7]", body in proptest::collection::vec(proptest::num::u8::ANY, 0..60),
            width in 0u32..9, height in 0u32..9, highest in 0u32..70_000,
        ) {
            let mut bytes = kind.into_bytes();
            let _ = samples(&[&bytes[..], &body].concat());
            bytes.extend(format!("\n{width} {height} {highest}\n").bytes());
            bytes.extend(body);
            if let Ok(samples) = samples(&bytes) {
                proptest::prop_assert_eq!(samples.len() as u32, width * height);
            }
        }
    }
}
