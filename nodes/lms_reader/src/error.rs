//! Errors between a device and topic `scan`.
//!
//! An error names the place: bytes of the stream count from its start, bytes of
//! a telegram from the first one of its content.

use std::path::PathBuf;

use sick::cola::Fault;

/// What was tried, what was found and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum LmsError {
    /// Bytes of the device are no telegram, or one that is damaged.
    #[error(transparent)]
    Telegram(#[from] sick::SickError),
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
    /// Nobody says which way the device looks.
    #[error(transparent)]
    Convention(#[from] sick::cola::ConventionError),
    /// The readings of an LMS2xx cannot be laid out as a scan.
    #[error("the device sent {found} readings, {expected} are {field}")]
    Readings {
        /// How many came.
        found: usize,
        /// How many a scan has.
        expected: usize,
        /// Of which field and resolution.
        field: String,
    },
    /// The device does not say when it measured, though it is to be asked.
    #[error("the telegram does not say the date and time of the scan (--stamps device): {found}")]
    NoTime {
        /// What it has instead.
        found: String,
    },
    /// The device refused a command.
    #[error("the device rejects {command} with CoLa error {fault}")]
    Fault {
        /// What was sent.
        command: String,
        /// Its answer.
        fault: Fault,
    },
    /// The device answered that it did not execute the command.
    #[error("the device did not {what}: it answers {found}, expected is {expected}")]
    Refused {
        /// What was asked for.
        what: &'static str,
        /// What it answered.
        found: String,
        /// What it answers where it is done.
        expected: String,
    },
    /// The device did not answer a command.
    #[error("the device did not answer {command}, sent {tries} times")]
    NoAnswer {
        /// What was sent.
        command: String,
        /// How often.
        tries: u32,
    },
    /// No baud rate brought an answer.
    #[error("no answer at any baud rate ({}); check power, wiring and that no other program uses the port", rates.iter().map(u32::to_string).collect::<Vec<_>>().join(", "))]
    NoBaud {
        /// Those that were tried.
        rates: Vec<u32>,
    },
    /// The device was started again and has to be set up again.
    #[error("the device was restarted")]
    Restarted,
    /// The device is not in order; its scans are sent all the same.
    #[error(
        "the device reports status {} {} (0 0 is in order, 0 1 an error, 0 2 a dirty window, \
         0 4 and 0 5 one that is too dirty)", found[0], found[1]
    )]
    DeviceStatus {
        /// Both bytes of the status.
        found: [u8; 2],
    },
    /// An LMS2xx is not in order; its scans are sent all the same.
    #[error(
        "the device reports status {:#04x}: level {} (3 is an error, 4 a fatal one){}{}",
        found.0, found.level(),
        if found.is_implausible() { ", implausible values" } else { "" },
        if found.is_polluted() { ", a dirty window" } else { "" }
    )]
    LmsStatus {
        /// The status byte.
        found: sick::lms2xx::Status,
    },
    /// The configuration names neither a device nor a capture.
    #[error("neither a device (--tcp, --serial) nor a capture (--capture) is given")]
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
    #[error("{address}: no data for {seconds} s; closing the connection")]
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
        "{}: no scan could be used, of {telegrams} telegrams; {}", path.display(),
        reason.as_deref().unwrap_or(
            "expected are CoLa telegrams `sSN LMDscandata` back to back"
        )
    )]
    NoScans {
        /// As configured.
        path: PathBuf,
        /// Sound telegrams of any kind.
        telegrams: u64,
        /// Why the last scan was refused, if there was one.
        reason: Option<String>,
    },
    /// The graph failed.
    #[error(transparent)]
    Transport(#[from] transport::TransportError),
}
