//! What `backcast probe` does.

use std::path::Path;
use std::process::ExitCode;

use super::{cola, lms2xx};
use crate::{BackcastError, stdout};

/// What stands below the options.
pub(crate) const NOTES: &str = "\
Without a port, 2112 and 2111 are tried; on a serial line, 38400, 9600, 500000 and 19200 baud.

Exit codes: 0 a device answered, 1 none did, 2 wrong use";

/// Columns where nobody says how many there are.
const COLUMNS: usize = 80;

/// What `backcast probe` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// The device: /dev/ttyUSB0, or tcp://HOST or tcp://HOST:PORT
    #[arg(value_name = "DEVICE")]
    device: String,

    /// Characters that the picture is wide [default: as the terminal, $COLUMNS or 80]
    #[arg(long, value_name = "CHARACTERS", value_parser = clap::value_parser!(u16).range(10..=500))]
    width: Option<u16>,
}

/// Asks the device and prints what it says.
///
/// # Errors
/// No device answers, or standard output cannot be written.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    let (said, seen) = match config.device.strip_prefix("tcp://") {
        Some(address) => cola::probe(address)?,
        None => lms2xx::probe(Path::new(&config.device))?,
    };
    let columns = config.width.map_or_else(columns, usize::from);
    stdout::print(&format!("{}\n\n{}", said.join("\n"), seen.draw(columns)))?;
    Ok(ExitCode::SUCCESS)
}

/// As wide as the terminal.
fn columns() -> usize {
    let (_, columns) = console::Term::stdout().size();
    let told = std::env::var("COLUMNS").ok();
    let told = told.and_then(|columns| columns.parse().ok());
    match console::Term::stdout().is_term() {
        true => usize::from(columns),
        false => told.unwrap_or(COLUMNS),
    }
    .clamp(10, 500)
}
