//! What `backcast locate` does: reads, asks scan by scan, and prints.

use std::path::PathBuf;
use std::process::ExitCode;

use recording::{Recording, RecordingError};

use super::object::Object;
use super::row;
use crate::cli::LOST_DATA;
use crate::offline::{Options, Progress, Session};
use crate::run::Line;
use crate::{BackcastError, stdout};

/// What `backcast locate` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// The recording: an MCAP file with ROS 2 messages
    #[arg(long, value_name = "FILE")]
    bag: PathBuf,

    /// Print JSON, an object a line
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    options: Options,
}

/// Prints a line for each scan. A scan that is refused has one too, with the
/// reason; one that does not decode is lost, and told on standard error.
///
/// # Errors
/// Map or recording cannot be used, or the recording is damaged: that is told
/// after what lies before the damage.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    config.options.check()?;
    let map = config.options.load_map()?;
    let recording = Recording::open(&config.bag)?;
    let mut session = Session::open(&recording, &config.options, map.as_ref())?;
    if !config.json {
        stdout::print(&format!("{}\n", Line::header()))?;
    }
    let progress = Progress::new("locating", session.scans.total());
    let mut code = ExitCode::SUCCESS;
    while let Some(scan) = session.scans.next() {
        match scan {
            Ok(scan) => {
                let map_id = session.world.map_id;
                let reply = session.ask(&scan)?;
                let line = match config.json {
                    true => Object::new(&scan, map_id, &reply).json(),
                    false => row::text(scan.stamp_ns, &reply),
                };
                if progress.print(&line)?.is_break() {
                    break;
                }
            }
            Err(error @ RecordingError::Message { .. }) => {
                progress.say(&error.to_string());
                code = ExitCode::from(LOST_DATA);
            }
            Err(error) => return Err(error.into()),
        }
        progress.step();
    }
    Ok(code)
}
