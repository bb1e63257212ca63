//! Everything that can go wrong between a device and `scan`.
//!
//! An error names the place: bytes of the stream count from its start, bytes of
//! a telegram from the first one of its content.

use std::path::PathBuf;

use crate::cola_b::{MAX_CONTENT, MIN_CONTENT};

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum LmsError {
    /// The bytes between two telegrams belong to none.
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
    /// A telegram claims a length that none has.
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
        found: u8,
        /// XOR of the content.
        computed: u8,
    },
    /// The checksum is right, but the content is not what its command says.
    #[error("byte {offset} of the stream: a telegram cannot be read: {reason}")]
    Unreadable {
        /// Of the telegram in the stream.
        offset: u64,
        /// What is wrong with it, and where.
        reason: Box<LmsError>,
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
    /// The content goes on after its last field.
    #[error("byte {offset} of the telegram: {left} bytes follow the last field, none may")]
    Trailing {
        /// Where the last field ended.
        offset: usize,
        /// Bytes that follow.
        left: usize,
    },
    /// The telegram has no channel of distances.
    #[error("the telegram has the 16-bit channels [{found}], a scan needs DIST1")]
    NoDistances {
        /// Names of its channels.
        found: String,
    },
    /// The distances cannot be laid out as a scan.
    #[error("`{field}` of channel DIST1 is {found}, allowed is {allowed}")]
    Scan {
        /// The field.
        field: &'static str,
        /// Its value.
        found: f64,
        /// What a scan needs.
        allowed: &'static str,
    },
    /// The device refused a command.
    #[error("the device answered with CoLa error {code:#06x} instead of starting the scan data")]
    Fault {
        /// SICK's number of the error.
        code: u16,
    },
    /// The device said that it does not send scans.
    #[error("the device answered that it sends no scans")]
    NotStarted,
    /// The device is not in order; its scans are sent all the same.
    #[error(
        "the device reports status {} {} (0 0 is in order, 0 1 an error, 0 2 a dirty window, \
         0 4 and 0 5 one that is too dirty)", found[0], found[1]
    )]
    DeviceStatus {
        /// Both bytes of the status.
        found: [u8; 2],
    },
    /// The configuration names neither a device nor a capture.
    #[error("neither a device (--tcp) nor a capture (--capture) is given")]
    NoSource,
    /// The device cannot be reached, or the connection ended.
    #[error("{address}: cannot {what}")]
    Device {
        /// As configured.
        address: String,
        /// What was tried.
        what: &'static str,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The device closed the connection.
    #[error("{address}: the device closed the connection")]
    Closed {
        /// As configured.
        address: String,
    },
    /// The device is connected but says nothing.
    #[error("{address}: not a byte for {seconds} s; the connection is given up")]
    Silent {
        /// As configured.
        address: String,
        /// How long was waited.
        seconds: f64,
    },
    /// The capture cannot be read.
    #[error("{}: cannot read the capture", path.display())]
    Capture {
        /// As configured.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The capture was played and there was no scan in it.
    #[error(
        "{}: no scan could be used, of {telegrams} telegrams; expected are CoLa B telegrams \
         `sSN LMDscandata` back to back", path.display()
    )]
    NoScans {
        /// As configured.
        path: PathBuf,
        /// Sound telegrams of any kind.
        telegrams: u64,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}

/// CoLa A is the likeliest mix-up, so it is named.
fn hint(found: [u8; 4]) -> &'static str {
    if found.starts_with(b"\x02s") {
        " (this looks like CoLa A, the text protocol: set the device to CoLa binary)"
    } else {
        ""
    }
}
