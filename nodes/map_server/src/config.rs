//! Command-line options.

use std::path::PathBuf;

use clap::Parser;

/// Serves a map file as `map`, and serves it again whenever the file changes.
#[derive(Debug, Clone, Parser)]
#[command(name = "map_server", version)]
pub struct Config {
    /// Map to serve: a YAML file in the format of ROS's map_server, with a PGM, PNG or BMP image
    /// next to it.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["maps", "recorded"])]
    pub map: Option<PathBuf>,

    /// Several maps to serve instead, which are searched together: a folder, or a file that lists
    /// maps, floors and transitions between them. They are served as `maps`; `map` is the one on
    /// which the robot is.
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with_all = ["map", "recorded", "played"])]
    pub maps: Option<PathBuf>,

    /// Serve only the maps and floors of the set with these names
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', requires = "maps")]
    pub on: Vec<String>,

    /// Recording whose last map is served instead of `--map`, if it contains one, and without
    /// `--map` has to: scans played from it were recorded on that map.
    #[arg(long, value_name = "FILE")]
    pub recorded: Option<PathBuf>,

    /// Recording that is played on `--map`; a warning is logged if it contains another map.
    #[arg(long, value_name = "FILE", conflicts_with = "recorded")]
    pub played: Option<PathBuf>,

    /// Rules for reading the map's cells, used by all nodes.
    #[command(flatten)]
    pub cells: messages::CellRules,

    #[command(flatten)]
    pub memory: map::MemoryOptions,
}
