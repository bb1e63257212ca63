//! What the first bytes of an image say: its sides, or a kind that is not read.

use std::path::Path;

use crate::MapError;

/// What is read of an image to see what it claims to be: more than its header takes.
pub(crate) const HEAD_BYTES: u64 = 64 << 10;

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

/// What the header of an image claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Claim {
    /// Pixels along x and y; 0 where the header is cut off.
    pub(crate) sides: (u32, u32),
    /// The most bytes that such an image may have.
    pub(crate) most_bytes: u64,
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
