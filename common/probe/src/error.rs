//! Errors of this crate's commands, and their exit codes.

use std::io;

use command_line::{CommandError, OutputError};

/// Why a laser cannot be asked.
#[derive(Debug, thiserror::Error)]
pub enum ProbeError {
    /// A laser cannot be reached, or hung up.
    #[error("{address}: no device can be reached; check its power, cable and address")]
    DeviceNotReached {
        /// As it was given, with the port that was tried last.
        address: String,
        /// Why not.
        source: io::Error,
    },
    /// Something is there, but no laser that we know.
    #[error(
        "{address}: no laser answers; tried {tried}; {}",
        match received {
            0 => "nothing came".to_owned(),
            n => format!("{n} bytes received that are not an answer: is it another device, or in use?"),
        }
    )]
    DeviceNotUnderstood {
        /// As it was given, with the port that was tried last.
        address: String,
        /// Bytes that came.
        received: usize,
        /// In which ways it was asked.
        tried: String,
    },
    /// Standard output takes no more.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl CommandError for ProbeError {}
