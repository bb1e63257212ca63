//! Detects the format of an image by its first bytes, as file names can be wrong and other readers
//! of maps do the same.

use std::path::Path;

use crate::claim::{Claim, wrong_kind};
use crate::raster::Raster;
use crate::{MapError, bmp, pgm, png};

type Read<T> = fn(&[u8], &Path) -> Result<T, MapError>;

/// Returns the readers of the header and of the whole image by its first bytes.
fn readers(head: &[u8], path: &Path) -> Result<(Read<Claim>, Read<Raster>), MapError> {
    if head.starts_with(png::SIGNATURE) {
        Ok((png::claim, png::decode))
    } else if head.starts_with(b"P2") || head.starts_with(b"P5") {
        Ok((pgm::claim, pgm::decode))
    } else if head.starts_with(bmp::SIGNATURE) {
        Ok((bmp::claim, bmp::decode))
    } else {
        Err(wrong_kind(head, path))
    }
}

pub(crate) fn decode(bytes: &[u8], path: &Path) -> Result<Raster, MapError> {
    readers(bytes, path)?.1(bytes, path)
}

pub(crate) fn claim(head: &[u8], path: &Path) -> Result<Claim, MapError> {
    readers(head, path)?.0(head, path)
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
