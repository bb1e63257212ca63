//! Standard output of the commands that print once and end.

use std::io::{self, ErrorKind, Write};

use crate::OutputError;

/// Writes `text`; a reader that went away is no failure.
///
/// # Errors
/// Writing failed otherwise.
pub fn print(text: &str) -> Result<(), OutputError> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(OutputError(error)),
        _ => Ok(()),
    }
}
