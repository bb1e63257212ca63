//! Command-line options.

use std::path::PathBuf;

use clap::Parser;
use command_line::number;
use messages::Name;
use ros_graph::replay::{Rate, Remap};

/// Plays a recording into the graph: scans, odometry and ground truth.
///
/// Exits with code 0 if everything was played, 1 on an error, 2 on wrong usage, or 3 if it finished
/// but lost data: a scan got no answer, a message could not be used, or the recording is damaged
/// from some point on.
#[derive(Debug, Clone, Parser)]
#[command(name = "replayer", version)]
pub struct Config {
    /// Recording to play: an MCAP file with ROS 2 messages, or a bag of rosbag2 (its folder, or
    /// .db3); several are played as one.
    #[arg(long, value_name = "FILE", required = true)]
    pub recording: Vec<PathBuf>,

    /// Topic of the scans [default: the only one, or /scan]; may be repeated for several lasers,
    /// and answers are expected for the scans of the first one
    #[arg(long, value_name = "TOPIC", conflicts_with = "cloud_topic")]
    pub scan_topic: Vec<String>,

    /// Topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,

    /// Playback speed as a multiple of the original, 0.001 to 1000; or max: each scan is sent after
    /// the answer to the previous one, and none is dropped.
    #[arg(long, value_name = "FACTOR|max", default_value_t = Rate::Factor(1.0))]
    pub rate: Rate,

    /// Repeat the recording without end.
    #[arg(long = "loop")]
    pub looped: bool,

    /// Start this many seconds after the recording's first message
    #[arg(long, value_name = "SECONDS", value_parser = number(0.0..=1e9, "seconds"))]
    pub start: Option<f64>,

    /// End this many seconds after the recording's first message
    #[arg(long, value_name = "SECONDS", value_parser = number(0.0..=1e9, "seconds"))]
    pub end: Option<f64>,

    /// Channels to play, separated by commas; all others are ignored
    #[arg(long, value_name = "TOPICS", value_delimiter = ',')]
    pub topics: Vec<String>,

    /// Rename a channel, as /front/scan:=/scan; separated by commas
    #[arg(long, value_name = "FROM:=TO", value_delimiter = ',')]
    pub remap: Vec<Remap>,

    /// Start paused: Enter plays to the next scan, `p` plays and pauses, `q` quits
    #[arg(long)]
    pub pause: bool,

    /// Nodes that must be ready before playback starts, separated by commas.
    #[arg(long, value_name = "NODES", value_delimiter = ',', value_parser = node)]
    pub wait_for: Vec<String>,

    /// Nodes that must also have received the last answer before the next scan is sent at --rate
    /// max, separated by commas: each counts the answers that it received in its reports on topic
    /// `health`
    #[arg(long, value_name = "NODES", value_delimiter = ',', value_parser = node)]
    pub in_step: Vec<String>,

    /// Timeout for an answer, seconds, 0.1 to 3600: to each scan at --rate max, otherwise to the
    /// last one if the scans have a subscriber.
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = number(0.1..=3600.0, "seconds"))]
    pub patience: f64,

    #[command(flatten)]
    pub cloud: ros::CloudOptions,
}

fn node(text: &str) -> Result<String, String> {
    match text.len() {
        1..=Name::CAPACITY if text != "replayer" => Ok(text.into()),
        1..=Name::CAPACITY => Err("it would wait for itself".into()),
        bytes => Err(format!(
            "it has {bytes} bytes, allowed are 1 to {}",
            Name::CAPACITY
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        for (arguments, expected) in [
            ("", "--recording"),
            ("--recording a --rate 0", "0.001 to 1000, and max"),
            ("--recording a --patience 0", "0.1 to 3600 seconds"),
            ("--recording a --start=-1", "0 to 1000000000 seconds"),
            ("--recording a --remap /f=/scan", "FROM:=TO"),
            (
                "--recording a --wait-for b,,c",
                "0 bytes, allowed are 1 to 32",
            ),
            ("--recording a --wait-for replayer", "wait for itself"),
        ] {
            let words = ["replayer"].into_iter().chain(arguments.split_whitespace());
            let outcome = Config::try_parse_from(words);
            let text = outcome.unwrap_err().to_string();
            assert!(text.contains(expected), "{arguments}: {text}");
        }
    }
}
