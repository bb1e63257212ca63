//! `backcast probe`: asks a device and prints its answers.

use std::path::Path;
use std::process::ExitCode;

use command_line::stdout;
use sick::cola::Encoding;

use super::{cola, lms2xx};

pub(crate) const NOTES: &str = "\
Without a port, 2112 and 2111 are tried; on a serial line, 38400, 9600, 500000 and 19200 baud.

Exit codes: 0 a device answered, 1 none did, 2 wrong use";

const COLUMNS: usize = 80;

/// Options of `backcast probe`.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// The device: an address such as 192.168.0.1, HOST or HOST:PORT (also after tcp://), or a
    /// serial line such as /dev/ttyUSB0
    #[arg(value_name = "DEVICE")]
    device: String,

    /// Width of the picture in characters [default: that of the terminal, $COLUMNS or 80]
    #[arg(long, value_name = "CHARACTERS", value_parser = clap::value_parser!(u16).range(10..=500))]
    width: Option<u16>,
}

pub(crate) fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let (said, seen) = match address(&config.device) {
        Some(address) => cola::probe(address)?,
        None => lms2xx::probe(Path::new(&config.device))?,
    };
    let columns = config.width.map_or_else(columns, usize::from);
    stdout::print(&format!("{}\n\n{}", said.join("\n"), seen.draw(columns)))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the options of `lms_reader` for the port and encoding on which a device answers.
pub(crate) fn reader_options(device: &str, is_serial: bool) -> anyhow::Result<Vec<String>> {
    match is_serial {
        false => cola::reader_options(address(device).unwrap_or(device)),
        true => lms2xx::ask(Path::new(device)).map(|()| default_reader_options(device, true)),
    }
}

/// Returns the options for a device with factory settings, without contacting it.
pub(crate) fn default_reader_options(device: &str, is_serial: bool) -> Vec<String> {
    if is_serial {
        return ["--serial", device].map(str::to_owned).to_vec();
    }
    let address = address(device).unwrap_or(device);
    cola::reader_options_of(&cola::addresses(address)[0], Encoding::Binary)
}

fn address(device: &str) -> Option<&str> {
    if let Some(address) = device.strip_prefix("tcp://") {
        return Some(address.trim_end_matches('/'));
    }
    let is_path = device.contains('/') || device.is_empty() || Path::new(device).exists();
    (!is_path).then_some(device)
}

/// Returns the width of the picture: that of the terminal, $COLUMNS or the default.
fn columns() -> usize {
    let (_, columns) = console::Term::stdout().size();
    let stated = std::env::var("COLUMNS").ok();
    let stated = stated.and_then(|columns| columns.parse().ok());
    match console::Term::stdout().is_term() {
        true => usize::from(columns),
        false => stated.unwrap_or(COLUMNS),
    }
    .clamp(10, 500)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_and_serial_lines_are_distinguished() {
        for (device, expected) in [
            ("192.168.0.1", Some("192.168.0.1")),
            ("192.168.0.1:2111", Some("192.168.0.1:2111")),
            ("laser", Some("laser")),
            ("front.local:2112", Some("front.local:2112")),
            ("fe80::1", Some("fe80::1")),
            ("tcp://laser:1/", Some("laser:1")),
            ("/dev/ttyUSB0", None),
            ("./laser", None),
            // Tests run in the crate's folder.
            ("Cargo.toml", None),
        ] {
            assert_eq!(address(device), expected, "{device}");
        }
    }
}
