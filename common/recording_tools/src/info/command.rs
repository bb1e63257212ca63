//! The command `backcast info`.

use std::path::PathBuf;
use std::process::ExitCode;

use command_line::LOST_DATA;
use offline::TopicOptions;

use super::contents::Contents;
use super::text;
use crate::each::each;

/// Options of `backcast info`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The recordings to describe: MCAP files, or bags of rosbag2 (their folders, or .db3)
    #[arg(required = true, value_name = "FILE")]
    recordings: Vec<PathBuf>,

    #[command(flatten)]
    topics: TopicOptions,

    /// Print JSON, one object per file
    #[arg(long)]
    json: bool,
}

/// Describes the given recordings one after another; a damaged one up to its damage.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    let any_failed = each(&config.recordings, &config.topics, |_, recording| {
        let contents = Contents::of(&recording);
        if contents.damage.is_some() {
            code = ExitCode::from(LOST_DATA);
        }
        Ok(match config.json {
            true => command_line::json::object(&contents) + "\n",
            false => text::of(&contents),
        })
    })?;
    Ok(match any_failed {
        true => ExitCode::FAILURE,
        false => code,
    })
}
