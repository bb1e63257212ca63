//! Command-line options.

use std::path::PathBuf;

use clap::Parser;

/// Serves a map file as `map`, and the new map whenever the file changes.
#[derive(Debug, Clone, Parser)]
#[command(name = "map_server", version)]
pub struct Config {
    /// The map: a YAML file as ROS's map_server reads it, beside a PGM, PNG or BMP
    /// image.
    #[arg(long, value_name = "FILE", required_unless_present = "maps")]
    pub map: Option<PathBuf>,

    /// Several maps in its place, which are searched together: a folder, or a file that names
    /// maps, floors and transitions between them. They are served as `maps`; `map` is the one
    /// on which the robot is.
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with_all = ["map", "recorded", "played"])]
    pub maps: Option<PathBuf>,

    /// Of a set, only the maps and floors with these names
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', requires = "maps")]
    pub on: Vec<String>,

    /// A recording whose last map is served in place of `--map`, if it holds one: what is
    /// played from it was recorded on that map.
    #[arg(long, value_name = "FILE")]
    pub recorded: Option<PathBuf>,

    /// A recording that is played on `--map`: where it holds another map, that is logged.
    #[arg(long, value_name = "FILE", conflicts_with = "recorded")]
    pub played: Option<PathBuf>,

    /// How cells of the map are read, by all nodes.
    #[command(flatten)]
    pub cells: messages::CellRules,

    /// What the graph may use.
    #[command(flatten)]
    pub memory: map::MemoryOptions,
}
