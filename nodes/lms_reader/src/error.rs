//! Errors between a device and topic `scan`.
//!
//! Each error gives its place: bytes of the stream count from its start, bytes of a telegram from
//! the first byte of its content.

use std::path::PathBuf;

use sick::cola::Fault;

#[derive(Debug, thiserror::Error)]
pub enum LmsError {
    /// The device sent bytes that are no telegram, or a damaged one.
    #[error(transparent)]
    Telegram(#[from] sick::SickError),
    #[error("the telegram has the 16-bit channels [{found}], a scan needs DIST1")]
    NoDistances { found: String },
    #[error("`{field}` of channel DIST1 is {found}, allowed is {allowed}")]
    Scan {
        field: &'static str,
        found: f64,
        allowed: &'static str,
    },
    #[error(transparent)]
    Convention(#[from] sick::cola::ConventionError),
    #[error("the device sent {found} readings, {expected} are {field}")]
    Readings {
        found: usize,
        expected: usize,
        field: String,
    },
    #[error("the telegram does not say the date and time of the scan (--stamps device): {found}")]
    NoTime { found: String },
    #[error("the device rejects {command} with CoLa error {fault}")]
    Fault { command: String, fault: Fault },
    #[error("the device did not {what}: it answers {found}, expected is {expected}")]
    Refused {
        what: &'static str,
        found: String,
        expected: String,
    },
    #[error("the device did not answer {command}, sent {tries} times")]
    NoAnswer { command: String, tries: u32 },
    #[error("no answer at any baud rate ({}); check power, wiring and that no other program uses the port", rates.iter().map(u32::to_string).collect::<Vec<_>>().join(", "))]
    NoBaud { rates: Vec<u32> },
    /// The device restarted and has to be set up again.
    #[error("the device was restarted")]
    Restarted,
    /// The device reports a problem; its scans are still published.
    #[error(
        "the device reports status {} {} (0 0 is in order, 0 1 an error, 0 2 a dirty window, \
         0 4 and 0 5 one that is too dirty)", found[0], found[1]
    )]
    DeviceStatus { found: [u8; 2] },
    /// An LMS2xx reports a problem; its scans are still published.
    #[error(
        "the device reports status {:#04x}: level {} (3 is an error, 4 a fatal one){}{}",
        found.0, found.level(),
        if found.is_implausible() { ", implausible values" } else { "" },
        if found.is_polluted() { ", a dirty window" } else { "" }
    )]
    LmsStatus { found: sick::lms2xx::Status },
    #[error("neither a device (--tcp, --serial) nor a capture (--capture) is given")]
    NoSource,
    #[error("{address}: cannot {what}")]
    Device {
        address: String,
        what: &'static str,
        source: std::io::Error,
    },
    #[error("{address}: the device closed the connection")]
    Closed { address: String },
    #[error("{address}: no data for {seconds} s; closing the connection")]
    Silent { address: String, seconds: f64 },
    #[error("{}: cannot read the capture", path.display())]
    Capture {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "{}: no scan could be used, of {telegrams} telegrams; {}", path.display(),
        reason.as_deref().unwrap_or(
            "expected are CoLa telegrams `sSN LMDscandata` back to back"
        )
    )]
    NoScans {
        path: PathBuf,
        /// Number of valid telegrams of any kind.
        telegrams: u64,
        /// Reason for rejecting the last scan, if there was one.
        reason: Option<String>,
    },
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
