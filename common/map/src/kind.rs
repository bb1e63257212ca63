//! Which kind of image a file holds, by its first bytes: names lie, and what reads
//! maps elsewhere goes by content as well.

use std::path::Path;

use crate::raster::Raster;
use crate::{MapError, bmp, pgm, png};

/// First bytes of kinds that are not read, beyond those that the image library
/// knows by name.
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

/// Decodes an image of any kind that is read; `path` is for errors.
pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Raster, MapError> {
    if bytes.starts_with(png::SIGNATURE) {
        png::decode(bytes, path)
    } else if bytes.starts_with(b"P2") || bytes.starts_with(b"P5") {
        pgm::decode(bytes, path)
    } else if bytes.starts_with(bmp::SIGNATURE) {
        bmp::decode(bytes, path)
    } else {
        Err(wrong_kind(bytes, path))
    }
}

/// What the header of an image claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Claim {
    /// Pixels along x and y; 0 where the header is cut off.
    pub(crate) sides: (u32, u32),
    /// The most bytes that such an image may have.
    pub(crate) most_bytes: u64,
}

/// What an image claims that begins with `head`; `path` is for errors.
pub(crate) fn claim(head: &[u8], path: &Path) -> Result<Claim, MapError> {
    if head.starts_with(png::SIGNATURE) {
        png::claim(head, path)
    } else if head.starts_with(b"P2") || head.starts_with(b"P5") {
        pgm::claim(head, path)
    } else if head.starts_with(bmp::SIGNATURE) {
        bmp::claim(head, path)
    } else {
        Err(wrong_kind(head, path))
    }
}

/// The error for a file of another kind.
pub(crate) fn wrong_kind(bytes: &[u8], path: &Path) -> MapError {
    MapError::ImageKind {
        path: path.to_owned(),
        found: name(bytes),
    }
}

fn name(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "nothing: it is empty".to_owned();
    }
    if let Some((_, name)) = OTHERS.iter().find(|(start, _)| bytes.starts_with(start)) {
        return (*name).to_owned();
    }
    if let Ok(format) = image::guess_format(bytes) {
        return format!("an image of kind {}", format!("{format:?}").to_uppercase());
    }
    let start = bytes.get(..8).unwrap_or(bytes);
    format!("\"{}\" at its start", start.escape_ascii())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_kinds_are_named() {
        for (image, found) in [
            (&b""[..], "nothing: it is empty"),
            (b"P6 1 1 255\n\x00\x00\x00", "a PPM (P6)"),
            (b"\xff\xd8\xff\xe0\x00\x10JFIF", "an image of kind JPEG"),
            (b"II*\x00\x08\x00\x00\x00", "an image of kind TIFF"),
            (b"GIF89a\x01\x00", "an image of kind GIF"),
            (b"hello", "\"hello\" at its start"),
            (
                b"\x00\x01\x02\x03\x04\x05\x06\x07\x08",
                "\"\\x00\\x01\\x02\\x03\\x04\\x05\\x06\\x07\" at its start",
            ),
        ] {
            let Err(error) = decode(image, Path::new("floor.pgm")) else {
                panic!("{found} is read");
            };
            assert_eq!(
                error.to_string(),
                format!("floor.pgm holds {found}; allowed: PGM (P2 or P5), PNG and BMP")
            );
        }
    }
}
