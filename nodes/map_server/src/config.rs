//! Command-line options.

use std::path::PathBuf;

use clap::Parser;

/// Serves a map file as `map`, and the new map whenever the file changes.
#[derive(Debug, Clone, Parser)]
#[command(name = "map_server", version)]
pub struct Config {
    /// The map: a YAML file as ROS's map_server reads it, beside a PGM, PNG or BMP
    /// image.
    #[arg(long, value_name = "FILE")]
    pub map: PathBuf,

    /// What the graph may use.
    #[command(flatten)]
    pub memory: map::MemoryOptions,
}
