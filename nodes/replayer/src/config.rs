//! Command-line options.

use std::path::PathBuf;

use clap::Parser;
use messages::Name;
use replay::{Rate, Remap};

/// Plays a recording into the graph: scans, odometry and true poses.
///
/// Ends with 0 when everything was played, 1 on an error, 2 on wrong usage, and
/// 3 when it finished but lost data: a scan without an answer, a message that
/// could not be used, or all that follows where the recording is damaged.
#[derive(Debug, Clone, Parser)]
#[command(name = "replayer", version)]
pub struct Config {
    /// The recording: an MCAP file with ROS 2 messages, or a bag of rosbag2 (its
    /// folder, or .db3); several are played as one.
    #[arg(long, value_name = "FILE", required = true)]
    pub recording: Vec<PathBuf>,

    /// The topic of the scans [default: the only one, or /scan]; several lasers are
    /// named one by one, the first one's scans are those that are answered
    #[arg(long, value_name = "TOPIC")]
    pub scan_topic: Vec<String>,

    /// The topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,

    /// Times the original speed, 0.001 to 1000; or max: the next scan follows
    /// the answer to the one before, and none is dropped.
    #[arg(long, value_name = "FACTOR|max", default_value_t = Rate::Factor(1.0))]
    pub rate: Rate,

    /// Repeats the recording.
    #[arg(long = "loop")]
    pub looped: bool,

    /// Starts this many seconds after the recording's first message
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub start: Option<f64>,

    /// Ends this many seconds after the recording's first message
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub end: Option<f64>,

    /// The channels to play, separated by commas; all others are ignored
    #[arg(long, value_name = "TOPICS", value_delimiter = ',')]
    pub topics: Vec<String>,

    /// Renames a channel, as /front/scan:=/scan; separated by commas
    #[arg(long, value_name = "FROM:=TO", value_delimiter = ',')]
    pub remap: Vec<Remap>,

    /// Starts paused: Enter plays to the next scan, `p` plays and pauses, `q` quits
    #[arg(long)]
    pub pause: bool,

    /// Nodes that must be ready before playing starts, separated by commas.
    #[arg(long, value_name = "NODES", value_delimiter = ',', value_parser = node)]
    pub wait_for: Vec<String>,

    /// Nodes that the next scan waits for at --rate max once the last one is answered, separated by
    /// commas: each counts in its reports in topic `health` how many answers it has taken
    #[arg(long, value_name = "NODES", value_delimiter = ',', value_parser = node)]
    pub in_step: Vec<String>,

    /// Timeout for an answer, seconds, 0.1 to 3600: of every scan at --rate max, else
    /// of the last one, if anybody listens.
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = patience)]
    pub patience: f64,
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

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=1e9).contains(&seconds) => Ok(seconds),
        _ => Err("allowed are 0 to 1e9 seconds".into()),
    }
}

fn patience(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.1..=3600.0).contains(&seconds) => Ok(seconds),
        _ => Err("allowed are 0.1 to 3600 seconds".into()),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["replayer"].into_iter().chain(arguments.split_whitespace());
        Config::try_parse_from(words).map_err(|error| error.to_string())
    }

    #[test]
    fn options() {
        Config::command().debug_assert();
        let config = parse("--recording a.mcap").unwrap();
        assert_eq!(config.rate, Rate::Factor(1.0));
        assert!(config.wait_for.is_empty() && !config.looped);
        let config = parse("--recording a --rate max --wait-for b,c --patience 2").unwrap();
        assert_eq!((config.rate, config.patience), (Rate::Max, 2.0));
        assert_eq!(config.wait_for, ["b", "c"]);
        let config = parse("--recording a --topics /s,/o --remap /f:=/scan --start 1").unwrap();
        assert_eq!((config.topics.len(), config.start), (2, Some(1.0)));
        assert_eq!(config.remap[0].to_string(), "/f:=/scan");
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("", "--recording");
        refuse("--recording a --rate 0", "0.001 to 1000, and max");
        refuse("--recording a --patience 0", "0.1 to 3600 seconds");
        refuse("--recording a --start=-1", "0 to 1e9 seconds");
        refuse("--recording a --remap /f=/scan", "FROM:=TO");
        refuse(
            "--recording a --wait-for b,,c",
            "0 bytes, allowed are 1 to 32",
        );
        refuse("--recording a --wait-for replayer", "wait for itself");
    }
}
