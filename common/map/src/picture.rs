//! Decodes the image of a map with the image library: PGM, PNG or BMP, which its first bytes say, as
//! file names can be wrong and other readers of maps do the same.

use std::io::{BufRead, Seek};
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use messages::limits::size_is_allowed;

use crate::grid::sizes_allowed;
use crate::{MapError, MemoryLimit};

/// First bytes of unsupported formats, in addition to those known to the image library.
const OTHERS: &[(&[u8], &str)] = &[
    (b"P1", "a PBM (P1)"),
    (b"P4", "a PBM (P4)"),
    (b"P3", "a PPM (P3)"),
    (b"P6", "a PPM (P6)"),
    (b"P7", "a PAM (P7)"),
    (b"\x1f\x8b", "a file packed with gzip"),
    (b"<svg", "an SVG"),
    (b"%PDF", "a PDF"),
];

/// Decodes an image; `path` is for errors. Its sides are checked before memory is allocated.
pub(crate) fn decode(
    mut file: impl BufRead + Seek,
    limit: MemoryLimit,
    path: &Path,
) -> Result<DynamicImage, MapError> {
    let damaged = MapError::damaged(path);
    let start = file.fill_buf().map_err(|error| damaged(error.into()))?;
    let format = format(start, path)?;
    let decoder = ImageReader::with_format(file, format)
        .into_decoder()
        .map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    if !size_is_allowed(width, height) {
        let claimed = format!("claims {width} x {height} cells; {}", sizes_allowed());
        return Err(MapError::invalid(path, claimed));
    }
    limit.check((width, height))?;
    DynamicImage::from_decoder(decoder).map_err(damaged)
}

fn format(start: &[u8], path: &Path) -> Result<ImageFormat, MapError> {
    let is_grey_map = start.starts_with(b"P2") || start.starts_with(b"P5");
    let found = match image::guess_format(start) {
        Ok(ImageFormat::Pnm) if is_grey_map => return Ok(ImageFormat::Pnm),
        Ok(format @ (ImageFormat::Png | ImageFormat::Bmp)) => return Ok(format),
        _ if start.is_empty() => "nothing: it is empty".to_owned(),
        guessed => match (
            OTHERS.iter().find(|(first, _)| start.starts_with(first)),
            guessed,
        ) {
            (Some((_, name)), _) => (*name).to_owned(),
            (None, Ok(format)) => {
                format!("an image of kind {}", format!("{format:?}").to_uppercase())
            }
            (None, Err(_)) => {
                let first = start.get(..8).unwrap_or(start);
                format!("\"{}\" at its start", first.escape_ascii())
            }
        },
    };
    let allowed = "allowed: PGM (P2 or P5), PNG and BMP";
    Err(MapError::invalid(path, format!("holds {found}; {allowed}")))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{GrayAlphaImage, GrayImage, Luma, RgbImage};

    use super::*;

    fn read(bytes: &[u8]) -> Result<DynamicImage, MapError> {
        decode(Cursor::new(bytes), MemoryLimit::NONE, Path::new("floor"))
    }

    fn greys(bytes: &[u8]) -> Vec<u16> {
        read(bytes).unwrap().into_luma16().into_raw()
    }

    fn written(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn grey_maps_of_one_and_two_bytes_and_of_text() {
        let of_bytes = greys(b"P5\n# drawn by hand\n3 1\n255\n\x00\x01\xff");
        assert_eq!(of_bytes, [0, 257, 65_535]);
        assert_eq!(greys(b"P5 2 1 65535\n\x12\x34\xff\xff"), [0x1234, 65_535]);
        assert_eq!(greys(b"P2\n2 1\n255\n254\t255\n"), [65_278, 65_535]);
        // Other maxima are scaled, here in steps of 8 bits.
        assert_eq!(greys(b"P5 2 1 100\n\x32\x64"), [128 * 257, 65_535]);
    }

    #[test]
    fn what_is_written_is_read_and_a_cut_file_is_no_other_image() {
        let grey = GrayImage::from_fn(64, 48, |x, y| Luma([(x * y / 8) as u8]));
        let faint = GrayAlphaImage::from_fn(5, 4, |x, y| [x as u8, y as u8].into());
        let colour = RgbImage::from_fn(5, 4, |x, y| [x as u8, y as u8, 9].into());
        let header = b"P5 64 48 255\n".to_vec();
        let written = |image: &DynamicImage, format| written(image.clone(), format);
        let [grey, faint, colour] = [grey.into(), faint.into(), colour.into()];
        for (image, bytes) in [
            (
                &grey,
                [header, DynamicImage::as_bytes(&grey).to_vec()].concat(),
            ),
            (&grey, written(&grey, ImageFormat::Png)),
            (&grey, written(&grey, ImageFormat::Bmp)),
            (&faint, written(&faint, ImageFormat::Png)),
            (&colour, written(&colour, ImageFormat::Png)),
            (&colour, written(&colour, ImageFormat::Bmp)),
        ] {
            let kind = bytes[..4].escape_ascii();
            let pixels = image.to_rgba16();
            assert!(read(&bytes).unwrap().into_rgba16() == pixels, "{kind}");
            for length in 0..bytes.len() {
                if let Ok(cut) = read(&bytes[..length]) {
                    assert!(cut.into_rgba16() == pixels, "{kind} cut at {length}");
                }
            }
            assert!(read(&bytes[..bytes.len() / 2]).is_err(), "{kind}");
        }
    }

    #[test]
    fn absurd_sizes_are_refused_before_anything_is_reserved() {
        let refusal = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
        let absurd = "floor claims 31623 x 31623 cells; allowed: sides of 1..=32767 and at most 400000000 cells";
        assert_eq!(refusal(b"P5 31623 31623 255\n"), absurd);
        let mut bitmap = written(GrayImage::new(1, 1), ImageFormat::Bmp);
        bitmap[18..22].copy_from_slice(&31_623i32.to_le_bytes());
        bitmap[22..26].copy_from_slice(&31_623i32.to_le_bytes());
        assert_eq!(refusal(&bitmap), absurd);
        // Within the limits, but the pixels are missing.
        let cut = "floor is damaged or cut short";
        assert_eq!(refusal(b"P5 16384 16384 65535\n"), cut);
        for header in [
            "P5 0 3 255\n",
            "P5 3 2 0\n",
            "P5 3 2 65536\n",
            "P5 99999999999 2 255\n",
        ] {
            assert!(read(header.as_bytes()).is_err(), "{header}");
        }
    }

    #[test]
    fn other_kinds_are_named() {
        for (image, found) in [
            (&b""[..], "nothing: it is empty"),
            (b"P6 1 1 255\n\x00\x00\x00", "a PPM (P6)"),
            (b"\xff\xd8\xff\xe0\x00\x10JFIF", "an image of kind JPEG"),
            (b"GIF89a\x01\x00", "an image of kind GIF"),
            (b"hello", "\"hello\" at its start"),
            (
                b"\x00\x01\x02\x03\x04\x05\x06\x07\x08",
                "\"\\x00\\x01\\x02\\x03\\x04\\x05\\x06\\x07\" at its start",
            ),
        ] {
            let expected = format!("floor holds {found}; allowed: PGM (P2 or P5), PNG and BMP");
            assert_eq!(read(image).unwrap_err().to_string(), expected);
        }
    }

    proptest::proptest! {
        #[test]
        fn no_bytes_make_it_panic(
            start in proptest::sample::select(vec![&b"P2"[..], b"P5", b"BM", b"\x89PNG\r\n\x1a\n", b""]),
            body in proptest::collection::vec(proptest::num::u8::ANY, 0..200),
            sides in "( [0-9]{1,2}){3}\n",
        ) {
            let _ = read(&[start, &body].concat());
            let _ = read(&[start, sides.as_bytes(), &body].concat());
        }

        #[test]
        fn a_flipped_bit_of_a_png_makes_no_other_image(at in 0usize..2000, bit in 0u8..8) {
            let image = GrayImage::from_fn(32, 32, |x, y| Luma([(x * 37 + y * 8) as u8]));
            let mut bytes = written(image.clone(), ImageFormat::Png);
            let at = at % bytes.len();
            bytes[at] ^= 1 << bit;
            if let Ok(read) = read(&bytes) {
                proptest::prop_assert_eq!(read.into_luma8(), image);
            }
        }
    }
}
