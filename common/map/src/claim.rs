//! Reads the sides and size limits of an image from its first bytes, or its unsupported format.

use std::path::Path;

use messages::limits::size_is_allowed;

use crate::MapError;
use crate::grid::sizes_allowed;

/// Number of bytes read to check the header; no header is longer.
pub(crate) const HEAD_BYTES: u64 = 64 << 10;

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

pub(crate) struct Claim {
    /// Width and height in pixels; 0 if the header is cut off.
    pub(crate) sides: (u32, u32),
    /// Largest valid file size in bytes.
    pub(crate) most_bytes: u64,
}

pub(crate) fn check_size(path: &Path, width: u32, height: u32) -> Result<(), MapError> {
    if size_is_allowed(width, height) {
        return Ok(());
    }
    Err(MapError::invalid(
        path,
        format!("claims {width} x {height} cells; {}", sizes_allowed()),
    ))
}

pub(crate) fn truncated(
    path: &Path,
    (width, height): (u32, u32),
    needed: u64,
    found: usize,
) -> MapError {
    MapError::invalid(
        path,
        format!(
            "is cut short: {width} x {height} cells need at least {needed} bytes, {found} are there"
        ),
    )
}

impl Claim {
    /// Size of an image whose header is cut off.
    pub(crate) const NONE: Claim = Claim {
        sides: (0, 0),
        most_bytes: HEAD_BYTES,
    };
}

pub(crate) fn wrong_kind(bytes: &[u8], path: &Path) -> MapError {
    let found = name(bytes);
    MapError::invalid(
        path,
        format!("holds {found}; allowed: PGM (P2 or P5), PNG and BMP"),
    )
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
