//! What the commands of `backcast` have in common: exit codes, standard output.

pub mod stdout;

use std::error::Error;
use std::io;

/// The exit code of a command that failed.
pub const FAILED: u8 = 1;
/// The exit code of what was started with the wrong options or settings.
pub const WRONG_USE: u8 = 2;
/// The exit code of a run that finished but lost data on the way.
pub const LOST_DATA: u8 = 3;

/// An error that ends a command.
pub trait CommandError: Error {
    /// The exit code that it means.
    fn exit_code(&self) -> u8 {
        FAILED
    }
}

/// Standard output takes no more.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output")]
pub struct OutputError(#[source] pub io::Error);
