//! What `backcast info` does.

use std::path::PathBuf;
use std::process::ExitCode;

use recording::Recording;

use super::contents::Contents;
use super::text;
use crate::cli::LOST_DATA;
use crate::{BackcastError, stdout};

/// What `backcast info` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// The recordings: MCAP files
    #[arg(required = true, value_name = "FILE")]
    recordings: Vec<PathBuf>,

    /// Print JSON, an object a file
    #[arg(long)]
    json: bool,
}

/// Describes one file after another, a damaged one as far as it is sound.
///
/// # Errors
/// A file cannot be read, or is no recording.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    let mut code = ExitCode::SUCCESS;
    for path in &config.recordings {
        let recording = Recording::open(path)?;
        let contents = Contents::of(&recording);
        if contents.damage.is_some() {
            code = ExitCode::from(LOST_DATA);
        }
        stdout::print(&match config.json {
            true => contents.json(),
            false => text::of(&contents),
        })?;
    }
    Ok(code)
}
