//! What all of them take on the command line.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use engine::directions::Directions;
use engine::grid::CellRules;
use engine::heading::HeadingConfig;
use engine::localizer::LocalizerConfig;
use engine::peaks::PeakConfig;
use map::OccupancyGrid;
use recording::Recording;

use super::progress::say;
use super::session::map_in;
use crate::BackcastError;

/// The map, the scans that are taken, and how they are searched.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Options {
    /// The map, a YAML file as map_server reads it, or another recording (.mcap or
    /// .db3) that holds one [default: the map in the recording]
    #[arg(long, value_name = "FILE")]
    pub(crate) map: Option<PathBuf>,

    /// Take each N-th scan, beginning with the first; 1 takes all
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) every: u64,

    #[command(flatten)]
    pub(crate) heading: HeadingConfig,

    #[command(flatten)]
    pub(crate) engine: EngineOptions,
}

/// All settings of the engine, as the nodes of the graph take them.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Engine")]
pub(crate) struct EngineOptions {
    #[command(flatten)]
    pub(crate) cells: CellRules,
    #[command(flatten)]
    pub(crate) localizer: LocalizerConfig,
    #[command(flatten)]
    pub(crate) peaks: PeakConfig,
}

impl Options {
    /// Checks what no option can check alone; opens nothing.
    ///
    /// # Errors
    /// Names the option and what is allowed.
    pub(crate) fn check(&self) -> Result<(), BackcastError> {
        Directions::new(self.engine.localizer.headings).map_err(BackcastError::Setting)?;
        self.heading.check().map_err(BackcastError::Usage)
    }

    /// The map that is named, if one is.
    ///
    /// # Errors
    /// It cannot be read.
    pub(crate) fn load_map(&self) -> Result<Option<OccupancyGrid>, BackcastError> {
        self.map.as_deref().map(map_of).transpose()
    }
}

/// The map of a YAML file, or that in a recording.
fn map_of(file: &Path) -> Result<OccupancyGrid, BackcastError> {
    let is_recording = |name: &OsStr| name == "mcap" || name == "db3";
    if file.extension().is_some_and(is_recording) {
        map_in(&Recording::open(file)?)
    } else {
        Ok(map::load_noting(file, |key| say(&key.to_string()))?)
    }
}
