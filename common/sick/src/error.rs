//! Everything that can be wrong with the bytes of a device.
//!
//! An error names the place: bytes of the stream count from its start, bytes of
//! a telegram from the first one of its content.

use crate::cola::cola_b::{MAX_CONTENT, MIN_CONTENT};
use crate::lms2xx::MAX_PAYLOAD;

/// What was found and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SickError {
    /// The bytes between two CoLa B telegrams belong to none.
    #[error(
        "byte {offset} of the stream: found {found:02x?} where a CoLa B telegram starts with \
         02 02 02 02{}", hint(*found)
    )]
    NoStart {
        /// In the stream.
        offset: u64,
        /// The first bytes that do not fit.
        found: [u8; 4],
    },
    /// The bytes between two other telegrams belong to none.
    #[error("byte {offset} of the stream: found {found:#04x} where {expected}")]
    NoTelegram {
        /// In the stream.
        offset: u64,
        /// The first byte that does not fit.
        found: u8,
        /// How telegrams begin.
        expected: &'static str,
    },
    /// A CoLa B telegram claims a length that none has.
    #[error(
        "byte {offset} of the stream: the telegram claims {found} bytes of content, allowed are \
         {MIN_CONTENT} to {MAX_CONTENT}"
    )]
    Length {
        /// Of the telegram in the stream.
        offset: u64,
        /// The claim.
        found: u32,
    },
    /// An LMS2xx telegram claims a length that none has.
    #[error(
        "byte {offset} of the stream: the telegram claims {found} bytes of payload, allowed are \
         1 to {MAX_PAYLOAD}"
    )]
    PayloadLength {
        /// Of the telegram in the stream.
        offset: u64,
        /// The claim.
        found: u16,
    },
    /// A CoLa A telegram has no end within the longest that is believed.
    #[error(
        "byte {offset} of the stream: a telegram without an end (03) in {MAX_TEXT} bytes",
        MAX_TEXT = crate::cola::cola_a::MAX_CONTENT
    )]
    Endless {
        /// Of the telegram in the stream.
        offset: u64,
    },
    /// Another telegram starts before a CoLa A telegram has ended.
    #[error(
        "byte {offset} of the stream: a telegram is cut off by another one after {present} bytes"
    )]
    CutOff {
        /// Of the telegram in the stream.
        offset: u64,
        /// Bytes of it that came.
        present: usize,
    },
    /// The content does not start with a command.
    #[error(
        "byte {offset} of the stream: the content starts with {found:#04x}, every command with \
         's' (0x73)"
    )]
    NotACommand {
        /// Of the telegram in the stream.
        offset: u64,
        /// The first byte of the content.
        found: u8,
    },
    /// The content changed on its way.
    #[error(
        "byte {offset} of the stream: the checksum of {length} bytes is {computed:#04x}, the \
         telegram ends with {found:#04x}"
    )]
    Checksum {
        /// Of the telegram in the stream.
        offset: u64,
        /// Bytes of content.
        length: usize,
        /// As sent.
        found: u16,
        /// Of what came.
        computed: u16,
    },
    /// The checksum is right, but the content is not what its command says.
    #[error("byte {offset} of the stream: a telegram cannot be read: {reason}")]
    Unreadable {
        /// Of the telegram in the stream.
        offset: u64,
        /// What is wrong with it, and where.
        reason: Box<SickError>,
    },
    /// The stream ends inside a telegram.
    #[error("byte {offset} of the stream: it ends {present} bytes into a telegram")]
    Truncated {
        /// Of the telegram in the stream.
        offset: u64,
        /// Bytes of it that came.
        present: usize,
    },
    /// The content ends before a field does.
    #[error(
        "byte {offset} of the telegram: `{field}` takes {needed} bytes, {left} are left of the \
         content"
    )]
    Short {
        /// The field.
        field: &'static str,
        /// Of the field in the content.
        offset: usize,
        /// Bytes that it takes.
        needed: usize,
        /// Bytes that are left.
        left: usize,
    },
    /// A field holds what it must not.
    #[error("byte {offset} of the telegram: `{field}` is {found}, allowed is {allowed}")]
    Field {
        /// The field.
        field: &'static str,
        /// Of the field in the content.
        offset: usize,
        /// Its value as text.
        found: String,
        /// What it may hold.
        allowed: &'static str,
    },
    /// The content continues after its last field.
    #[error("byte {offset} of the telegram: {left} bytes follow the last field, none may")]
    Trailing {
        /// Where the last field ended.
        offset: usize,
        /// Bytes that follow.
        left: usize,
    },
}

/// CoLa A is the likeliest mix-up, so it is named.
fn hint(found: [u8; 4]) -> &'static str {
    if found.starts_with(b"\x02s") {
        " (this looks like CoLa A, the text protocol: set the device to CoLa binary)"
    } else {
        ""
    }
}
