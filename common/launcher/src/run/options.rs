//! Options of `backcast run`.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::path::PathBuf;

use clap::Args;
use engine::heading::HeadingConfig;
use transport::{GRAPH_VARIABLE, GraphName, TransportError};

use crate::descriptor::DEFAULT_FILE;

/// Rate at which each answer is awaited and nothing may be lost.
pub(crate) const MAX_RATE: &str = "max";

#[derive(Debug, Args)]
pub struct Config {
    /// The graph's descriptor
    #[arg(default_value = DEFAULT_FILE, value_name = "FILE")]
    pub dataflow: PathBuf,
    #[command(flatten)]
    pub options: Options,
}

impl Config {
    pub fn with(options: Options) -> Self {
        let dataflow = DEFAULT_FILE.into();
        Config { dataflow, options }
    }
}

/// Options of `run`, which also work without the subcommand.
#[derive(Debug, Clone, Default, Args)]
pub struct Options {
    /// Replay this recording in place of the graph's laser, on its own map if it holds one;
    /// several files are replayed as one
    #[arg(long, value_name = "FILE")]
    pub replay: Vec<PathBuf>,

    /// With --replay: the topic of the scans [default: the only one, or /scan];
    /// several are joined
    #[arg(
        long,
        value_name = "TOPIC",
        requires = "replay",
        conflicts_with = "cloud_topic"
    )]
    pub scan_topic: Vec<String>,

    /// With --replay: the topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC", requires = "replay")]
    pub odom_topic: Option<String>,

    #[command(flatten)]
    pub cloud: ros::CloudOptions,

    /// Playback speed as a factor, or `max`: wait for each answer and lose nothing
    #[arg(long, value_name = "FACTOR|max", value_parser = rate)]
    pub rate: Option<String>,

    /// Repeat the recording, until Ctrl-C
    #[arg(long = "loop")]
    pub repeat: bool,

    /// Serve this map instead of the one in the descriptor
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,

    /// Serve the maps of this folder, or of this file that lists them, and search all of them
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with = "map")]
    pub maps: Option<PathBuf>,

    /// Not for a graph: its map comes from map_server, see --map
    #[arg(long, value_name = "TOPIC", requires = "replay", hide = true)]
    pub map_topic: Option<String>,

    #[command(flatten)]
    pub heading: HeadingConfig,

    #[command(flatten)]
    pub record: RecordOptions,

    /// Skip the build commands of the descriptor, and start the existing executables
    #[arg(long)]
    pub no_build: bool,

    /// Do not start the web page
    #[arg(long)]
    pub no_monitor: bool,

    /// Also show the graph live in Foxglove and Lichtblick, on ws://127.0.0.1:8765
    #[arg(long)]
    pub foxglove: bool,

    /// The graph's name, by which other tools join it: 1 to 20 of a-z 0-9 - _ [default:
    /// $BACKCAST_GRAPH, or a generated name]
    #[arg(long, value_name = "NAME", value_parser = GraphName::new)]
    pub graph: Option<GraphName>,

    /// Also write the log of each node to NODE.jsonl in this folder, as JSON lines; the
    /// last 50 MB of each node are kept
    #[arg(long, value_name = "FOLDER")]
    pub log_folder: Option<PathBuf>,

    /// Print JSON, one object per line; the last one is the summary
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Clone, Default, Args)]
pub struct RecordOptions {
    /// Record the graph to this MCAP file
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,

    /// With --record: overwrite the file
    #[arg(long, requires = "record")]
    pub force: bool,

    /// With --record: keep only this much time in memory, e.g. 10m, and save it when the
    /// pose is lost or the recorder gets SIGUSR1
    #[arg(long, value_name = "TIME", requires = "record")]
    pub keep: Option<String>,

    /// With --record: start a new file after this much time, e.g. 10m
    #[arg(
        long,
        value_name = "TIME",
        requires = "record",
        conflicts_with = "keep"
    )]
    pub split_time: Option<String>,

    /// With --record: start a new file after this many megabytes
    #[arg(long, value_name = "MB", requires = "record", conflicts_with = "keep")]
    pub split_size: Option<String>,

    /// With --record: also record the intensity image, which is then computed
    #[arg(long, requires = "record")]
    pub record_field: bool,
}

impl RecordOptions {
    /// Returns the options that end a file before the graph does, with their values.
    pub(crate) fn ending(&self) -> [(&'static str, Option<&str>); 3] {
        [
            ("--keep", self.keep.as_deref()),
            ("--split-time", self.split_time.as_deref()),
            ("--split-size", self.split_size.as_deref()),
        ]
    }
}

impl Options {
    /// Returns the name of the graph to start: from the option, from the environment, or a random
    /// one. A random name is unique even among containers that share the memory of this machine.
    pub fn graph_name(&self) -> Result<GraphName, TransportError> {
        match &self.graph {
            Some(name) => Ok(name.clone()),
            None if std::env::var_os(GRAPH_VARIABLE).is_some() => GraphName::from_environment(),
            None => GraphName::new(&format!("bc{:08x}", random())),
        }
    }
}

/// Returns a random number. Process ids would repeat from container to container.
fn random() -> u32 {
    let hasher = RandomState::new().build_hasher();
    // The upper half is as random as the lower one.
    (hasher.finish() >> 32) as u32
}

fn rate(text: &str) -> Result<String, String> {
    let is_factor = |factor: f64| factor.is_finite() && factor > 0.0;
    match text == MAX_RATE || text.parse().is_ok_and(is_factor) {
        true => Ok(text.to_owned()),
        false => Err("allowed are a number above 0, as 0.5 or 10, and `max`".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graph_that_nobody_names_has_a_name_of_its_own() {
        let named = crate::run::testing::options("--graph robot7");
        assert_eq!(named.graph_name().unwrap().as_str(), "robot7");
        let own = || Options::default().graph_name().unwrap();
        assert!(own().as_str().starts_with("bc"));
        assert_ne!(own(), own(), "two of one process");
    }
}
