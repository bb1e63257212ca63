//! Errors in the bytes of a device.
//!
//! Each error gives its place: bytes of the stream count from its start, bytes of a telegram from
//! the first byte of its content.

use std::ops::RangeInclusive;

/// Error in a stream or telegram: the value found and the values allowed. The `offset` is that of
/// the first byte of the telegram or of the field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SickError {
    #[error(
        "byte {offset} of the stream: found {found:02x?} where a CoLa B telegram starts with \
         02 02 02 02{}", hint(*found)
    )]
    NoStart { offset: u64, found: [u8; 4] },
    #[error("byte {offset} of the stream: found {found:#04x} where {expected}")]
    NoTelegram {
        offset: u64,
        found: u8,
        expected: &'static str,
    },
    #[error(
        "byte {offset} of the stream: the telegram claims {found} bytes of {part}, allowed are \
         {} to {}", allowed.start(), allowed.end()
    )]
    Length {
        offset: u64,
        found: u32,
        part: &'static str,
        allowed: RangeInclusive<usize>,
    },
    #[error(
        "byte {offset} of the stream: a telegram without an end (03) in {MAX_TEXT} bytes",
        MAX_TEXT = crate::cola::cola_a::MAX_CONTENT
    )]
    Endless { offset: u64 },
    #[error(
        "byte {offset} of the stream: a telegram is cut off by another one after {present} bytes"
    )]
    CutOff { offset: u64, present: usize },
    #[error(
        "byte {offset} of the stream: the content starts with {found:#04x}, every command with \
         's' (0x73)"
    )]
    NotACommand { offset: u64, found: u8 },
    /// The checksum is wrong: the content was changed in transit.
    #[error(
        "byte {offset} of the stream: the checksum of {length} bytes is {computed:#04x}, the \
         telegram ends with {found:#04x}"
    )]
    Checksum {
        offset: u64,
        length: usize,
        found: u16,
        computed: u16,
    },
    /// The checksum is right, but the content does not fit its command.
    #[error("byte {offset} of the stream: a telegram cannot be read: {reason}")]
    Unreadable { offset: u64, reason: Box<SickError> },
    #[error("byte {offset} of the stream: it ends {present} bytes into a telegram")]
    Truncated { offset: u64, present: usize },
    #[error(
        "byte {offset} of the telegram: `{field}` takes {needed} bytes, {left} are left of the \
         content"
    )]
    Short {
        field: &'static str,
        offset: usize,
        needed: usize,
        left: usize,
    },
    #[error("byte {offset} of the telegram: `{field}` is {found}, allowed is {allowed}")]
    Field {
        field: &'static str,
        offset: usize,
        found: String,
        allowed: &'static str,
    },
    #[error("byte {offset} of the telegram: {left} bytes follow the last field, none may")]
    Trailing { offset: usize, left: usize },
}

/// Returns a hint if this looks like CoLa A, the most likely mix-up.
fn hint(found: [u8; 4]) -> &'static str {
    if found.starts_with(b"\x02s") {
        " (this looks like CoLa A, the text protocol: set the device to CoLa binary)"
    } else {
        ""
    }
}
