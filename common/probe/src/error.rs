//! Errors of this crate's commands, and their exit codes.

use std::io;

use command_line::{CommandError, OutputError};

/// Error of probing a laser.
#[derive(Debug, thiserror::Error)]
pub enum ProbeError {
    /// The device cannot be reached, or closed the connection.
    #[error("{address}: no device can be reached; check its power, cable and address")]
    DeviceNotReached {
        /// Address as given, with the last port tried.
        address: String,
        source: io::Error,
    },
    /// A device is there, but does not answer like a known laser.
    #[error(
        "{address}: no laser answers; tried {tried}; {}",
        match received {
            0 => "nothing came".to_owned(),
            n => format!("{n} bytes received that are not an answer: is it another device, or in use?"),
        }
    )]
    DeviceNotUnderstood {
        /// Address as given, with the last port tried.
        address: String,
        /// Number of bytes received.
        received: usize,
        /// Protocols that were tried.
        tried: String,
    },
    /// Standard output cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for ProbeError {}
