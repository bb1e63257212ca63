//! Errors in the bytes of a device.
//!
//! Each error gives its place: bytes of the stream count from its start, bytes of a telegram from
//! the first byte of its content.

use crate::cola::cola_b::{MAX_CONTENT, MIN_CONTENT};
use crate::lms2xx::MAX_PAYLOAD;

/// Error in a stream or telegram: the value found and the values allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SickError {
    /// Bytes between two CoLa B telegrams belong to neither.
    #[error(
        "byte {offset} of the stream: found {found:02x?} where a CoLa B telegram starts with \
         02 02 02 02{}", hint(*found)
    )]
    NoStart {
        /// Byte in the stream.
        offset: u64,
        /// First bytes that do not fit.
        found: [u8; 4],
    },
    /// Bytes between two other telegrams belong to neither.
    #[error("byte {offset} of the stream: found {found:#04x} where {expected}")]
    NoTelegram {
        /// Byte in the stream.
        offset: u64,
        /// First byte that does not fit.
        found: u8,
        /// Expected beginning of a telegram.
        expected: &'static str,
    },
    /// A CoLa B telegram claims an impossible length.
    #[error(
        "byte {offset} of the stream: the telegram claims {found} bytes of content, allowed are \
         {MIN_CONTENT} to {MAX_CONTENT}"
    )]
    Length {
        /// Start of the telegram in the stream.
        offset: u64,
        found: u32,
    },
    /// An LMS2xx telegram claims an impossible length.
    #[error(
        "byte {offset} of the stream: the telegram claims {found} bytes of payload, allowed are \
         1 to {MAX_PAYLOAD}"
    )]
    PayloadLength {
        /// Start of the telegram in the stream.
        offset: u64,
        found: u16,
    },
    /// A CoLa A telegram does not end within the longest length accepted.
    #[error(
        "byte {offset} of the stream: a telegram without an end (03) in {MAX_TEXT} bytes",
        MAX_TEXT = crate::cola::cola_a::MAX_CONTENT
    )]
    Endless {
        /// Start of the telegram in the stream.
        offset: u64,
    },
    /// Another telegram starts before a CoLa A telegram has ended.
    #[error(
        "byte {offset} of the stream: a telegram is cut off by another one after {present} bytes"
    )]
    CutOff {
        /// Start of the telegram in the stream.
        offset: u64,
        /// Number of its bytes received.
        present: usize,
    },
    /// The content does not start with a command.
    #[error(
        "byte {offset} of the stream: the content starts with {found:#04x}, every command with \
         's' (0x73)"
    )]
    NotACommand {
        /// Start of the telegram in the stream.
        offset: u64,
        found: u8,
    },
    /// The checksum is wrong: the content was changed in transit.
    #[error(
        "byte {offset} of the stream: the checksum of {length} bytes is {computed:#04x}, the \
         telegram ends with {found:#04x}"
    )]
    Checksum {
        /// Start of the telegram in the stream.
        offset: u64,
        length: usize,
        found: u16,
        computed: u16,
    },
    /// The checksum is right, but the content does not fit its command.
    #[error("byte {offset} of the stream: a telegram cannot be read: {reason}")]
    Unreadable {
        /// Start of the telegram in the stream.
        offset: u64,
        /// The error in the content, with its place.
        reason: Box<SickError>,
    },
    /// The stream ends inside a telegram.
    #[error("byte {offset} of the stream: it ends {present} bytes into a telegram")]
    Truncated {
        /// Start of the telegram in the stream.
        offset: u64,
        /// Number of its bytes received.
        present: usize,
    },
    /// The content ends before a field does.
    #[error(
        "byte {offset} of the telegram: `{field}` takes {needed} bytes, {left} are left of the \
         content"
    )]
    Short {
        field: &'static str,
        /// Start of the field in the content.
        offset: usize,
        needed: usize,
        left: usize,
    },
    /// A field has an invalid value.
    #[error("byte {offset} of the telegram: `{field}` is {found}, allowed is {allowed}")]
    Field {
        field: &'static str,
        /// Start of the field in the content.
        offset: usize,
        found: String,
        allowed: &'static str,
    },
    /// The content continues after the last field.
    #[error("byte {offset} of the telegram: {left} bytes follow the last field, none may")]
    Trailing {
        /// End of the last field.
        offset: usize,
        left: usize,
    },
}

/// Returns a hint if this looks like CoLa A, the most likely mix-up.
fn hint(found: [u8; 4]) -> &'static str {
    if found.starts_with(b"\x02s") {
        " (this looks like CoLa A, the text protocol: set the device to CoLa binary)"
    } else {
        ""
    }
}
