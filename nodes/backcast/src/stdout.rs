//! Standard output of the commands that print once and end.

use std::io::{self, ErrorKind, Write};

use crate::BackcastError;

/// Writes `text`; a reader that went away is no failure.
///
/// # Errors
/// Writing failed otherwise.
pub(crate) fn print(text: &str) -> Result<(), BackcastError> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(BackcastError::Output(error)),
        _ => Ok(()),
    }
}
