//! Standard output of commands that print once and end.

use std::io::{self, ErrorKind, Write};

use crate::OutputError;

/// Writes `text`; a closed reader is no error.
pub fn print(text: &str) -> Result<(), OutputError> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(OutputError(error)),
        _ => Ok(()),
    }
}
