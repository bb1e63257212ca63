//! Command-line options.

use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;

use crate::{Event, duration};

/// Records the graph to an MCAP file with ROS 2 messages.
///
/// Exits with code 0, 1 on an error, 2 on wrong usage, or 3 if data was lost. Everything recorded
/// is on its way to the disk within a second. An existing file is never overwritten; the recording
/// then goes to a file with a number after its name.
#[derive(Debug, Clone, Parser)]
#[command(name = "recorder", version)]
pub struct Config {
    /// File of the recording; with --keep, the base of the names of saved files
    #[arg(long, value_name = "FILE")]
    pub output: PathBuf,

    /// Start a new file after this many megabytes (10^6 bytes), at least 1
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(1..))]
    pub split_size: Option<u64>,

    /// Start a new file after this much time, as 90s, 10m or 1.5h
    #[arg(long, value_name = "TIME", value_parser = duration::parse)]
    pub split_time: Option<Duration>,

    /// Keep only this much time in memory, as 10m, and write it on SIGUSR1 and on events
    #[arg(long, value_name = "TIME", value_parser = duration::parse,
          conflicts_with_all = ["split_size", "split_time"])]
    pub keep: Option<Duration>,

    /// Memory limit for --keep, megabytes (10^6 bytes); the oldest messages are dropped
    /// first
    #[arg(long, value_name = "MB", default_value_t = 512, requires = "keep",
          value_parser = clap::value_parser!(u64).range(1..))]
    pub keep_size: u64,

    /// Number of files that --keep leaves on the disk; the oldest ones are removed
    #[arg(long, value_name = "COUNT", default_value_t = 20, requires = "keep",
          value_parser = clap::value_parser!(u32).range(1..))]
    pub keep_files: u32,

    /// Size of all files that --keep leaves on the disk, megabytes (10^6 bytes); the oldest ones
    /// are removed, but never the newest
    #[arg(long, value_name = "MB", default_value_t = 4000, requires = "keep",
          value_parser = clap::value_parser!(u64).range(1..))]
    pub keep_disk: u64,

    /// Events on which --keep saves, separated by commas; events whose file would overlap the last
    /// one are saved together in the next file
    #[arg(
        long,
        value_name = "EVENTS",
        value_delimiter = ',',
        requires = "keep",
        default_value = "lost-pose"
    )]
    pub save_on: Vec<Event>,

    /// Interval at which the file is synced to the disk, as 1s, which limits the loss in a power
    /// failure; or never, which leaves it to the system (some 30 s)
    #[arg(long, value_name = "TIME|never", default_value = "5s", value_parser = SyncPeriod::parse)]
    pub sync: SyncPeriod,

    /// File to attach to the recording; may be repeated
    #[arg(long, value_name = "FILE")]
    pub attach: Vec<PathBuf>,

    /// Also record the intensity image, which the accumulator then computes
    #[arg(long)]
    pub field: bool,

    #[command(flatten)]
    pub transcript: ros_graph::export::Options,

    /// Limit of the queue for a slow or full disk, megabytes (10^6 bytes); further
    /// messages are dropped and counted
    #[arg(long, value_name = "MB", default_value_t = 128,
          value_parser = clap::value_parser!(u64).range(1..))]
    pub queue_size: u64,
}

/// Interval at which a recording is synced to the disk; `None` for never.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SyncPeriod(pub Option<Duration>);

impl SyncPeriod {
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "never" => Ok(SyncPeriod(None)),
            _ => duration::parse(text)
                .map(|period| SyncPeriod(Some(period)))
                .map_err(|error| format!("{error}; or never")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        for (arguments, expected) in [
            ("", "--output"),
            ("--output r --split-size 0", "0 is not in 1.."),
            ("--output r --split-time soon", "as 90s, 10m"),
            ("--output r --sync often", "or never"),
            (
                "--output r --keep 1m --split-time 1m",
                "cannot be used with",
            ),
            ("--output r --save-on lost-pose", "--keep"),
            ("--output r --base-frame=", "allowed are 1 to 256"),
        ] {
            let words = ["recorder"].into_iter().chain(arguments.split_whitespace());
            let outcome = Config::try_parse_from(words);
            let text = outcome.unwrap_err().to_string();
            assert!(text.contains(expected), "{arguments}: {text}");
        }
    }
}
