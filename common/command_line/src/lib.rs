//! Common parts of commands and nodes: settings and numbers in options, output, JSON, and exit
//! codes.

pub mod json;
pub mod names;
mod number;
pub mod output;
pub mod settings;
pub mod stdout;

pub use number::{number, within};

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, error::ErrorKind};

/// Exit code of a command that failed.
pub const FAILED: u8 = 1;
/// Exit code of a command with wrong options or settings.
pub const WRONG_USE: u8 = 2;
/// Exit code of a run that finished but lost data.
pub const LOST_DATA: u8 = 3;

/// Returns the exit code of a run that finished.
pub fn finished(lost_data: bool) -> ExitCode {
    match lost_data {
        true => ExitCode::from(LOST_DATA),
        false => ExitCode::SUCCESS,
    }
}

/// Parses the command line; exits with code 2 if it is invalid or `check` finds a problem.
pub fn parse<C: Parser>(check: impl FnOnce(&C) -> Result<(), String>) -> C {
    let config = C::parse();
    if let Err(problem) = check(&config) {
        C::command()
            .error(ErrorKind::ValueValidation, problem)
            .exit()
    }
    config
}

/// Wrong options or settings of a command, found after parsing.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct WrongUse(String);

/// Returns an error that ends a command with [`WRONG_USE`].
pub fn wrong_use(message: impl Into<String>) -> anyhow::Error {
    WrongUse(message.into()).into()
}

/// Returns the exit code of a command that ends with this error.
pub fn exit_code(error: &anyhow::Error) -> u8 {
    match error.is::<WrongUse>() {
        true => WRONG_USE,
        false => FAILED,
    }
}

/// Writes a remark to standard error; a closed one is ignored.
pub fn say(remark: &str) {
    let _ = writeln!(io::stderr().lock(), "backcast: {remark}");
}

/// Standard output cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output")]
pub struct OutputError(#[source] pub io::Error);
