//! Options of all of them.

use std::path::{Path, PathBuf};

use engine::directions::Directions;
use engine::grid::CellRules;
use engine::heading::HeadingConfig;
use engine::joined::MotionConfig;
use engine::localizer::LocalizerConfig;
use engine::peaks::PeakConfig;
use index_cache::IndexCacheConfig;
use map::OccupancyGrid;
use progress::say;
use recording::{Kind, Recording};

use super::maps::map_in;
use super::topics::TopicOptions;
use crate::OfflineError;

/// The map, the scans that are taken, and how they are searched.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// The map, a YAML file as map_server reads it, or another recording that
    /// holds one; `locate` searches several together if it is given several times
    /// [default: in the recording, the newest before each scan]
    #[arg(long, value_name = "FILE")]
    pub map: Vec<PathBuf>,

    /// Which channels are meant.
    #[command(flatten)]
    pub topics: TopicOptions,

    /// Take every N-th scan, starting with the first; 1 takes all
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub every: u64,

    /// Where the heading comes from.
    #[command(flatten)]
    pub heading: HeadingConfig,

    /// How motion within a scan is taken out.
    #[command(flatten)]
    pub motion: MotionConfig,

    /// The engine's settings.
    #[command(flatten)]
    pub engine: EngineOptions,

    /// Where prepared maps are kept.
    #[command(flatten, next_help_heading = "Kept maps")]
    pub index_cache: IndexCacheConfig,
}

/// A map of several.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedMap {
    /// What it is called.
    pub name: String,
    /// The floor, where the set says so.
    pub floor: Option<String>,
    /// The map.
    pub grid: OccupancyGrid,
}

/// All settings of the engine, as the nodes of the graph take them.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Engine")]
pub struct EngineOptions {
    /// What the values of cells mean.
    #[command(flatten)]
    pub cells: CellRules,
    /// How the best poses are searched.
    #[command(flatten)]
    pub localizer: LocalizerConfig,
    /// How the poses found are judged.
    #[command(flatten)]
    pub peaks: PeakConfig,
}

impl Options {
    /// Checks what no option can check alone, and that there is one map at most; opens
    /// nothing.
    ///
    /// # Errors
    /// Names the option and what is allowed.
    pub fn check(&self) -> Result<(), OfflineError> {
        let maps = self.map.len();
        if maps > 1 {
            return Err(OfflineError::Usage(format!(
                "--map is given {maps} times: only `backcast locate` searches several maps"
            )));
        }
        self.check_settings()
    }

    /// The same where there may be several maps.
    ///
    /// # Errors
    /// Names the option and what is allowed.
    pub fn check_settings(&self) -> Result<(), OfflineError> {
        Directions::new(self.engine.localizer.headings).map_err(OfflineError::Setting)?;
        self.heading.check().map_err(OfflineError::Usage)
    }

    /// The same options with this map.
    #[must_use]
    pub fn with_map(&self, file: &Path) -> Self {
        Options {
            map: vec![file.to_owned()],
            ..self.clone()
        }
    }

    /// The map that is named, if one is; recordings to be searched are named, too,
    /// for the case that the two were swapped.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn load_map(&self, recordings: &[PathBuf]) -> Result<Option<OccupancyGrid>, OfflineError> {
        let file = self.map.first();
        file.map(|file| self.load(file, recordings)).transpose()
    }

    /// The maps that are named, if there are several: by `--map`, or those of a set, which is
    /// a folder or a file that lists them. Where names of maps or floors are given, only those.
    ///
    /// # Errors
    /// One of them cannot be read, the set is none, or has no such map and no such floor.
    pub fn load_set(
        &self,
        set: Option<&Path>,
        on: &[String],
        recordings: &[PathBuf],
    ) -> Result<Vec<NamedMap>, OfflineError> {
        let files = match set {
            Some(set) => map::set_of_noting(set, say)?,
            None if self.map.len() > 1 || !on.is_empty() => map::set_of_files(&self.map)?,
            None => return Ok(Vec::new()),
        };
        let load = |map::MapFile { name, yaml, floor }: map::MapFile| {
            let grid = self.load(&yaml, recordings)?;
            Ok(NamedMap { name, floor, grid })
        };
        files.select(on)?.maps.into_iter().map(load).collect()
    }

    fn load(&self, file: &Path, recordings: &[PathBuf]) -> Result<OccupancyGrid, OfflineError> {
        if !recording::is_recording(file) {
            let grid = map::load_noting(file, |key| say(&key.to_string()))?;
            return Ok(grid);
        }
        if let Some(other) = recordings.iter().find(|path| is_map(path)) {
            let (other, file) = (other.display(), file.display());
            return Err(OfflineError::Usage(format!(
                "{other} is a map, and --map {file} a recording: the two look swapped"
            )));
        }
        let mut recording = Recording::open(file)?;
        if let Some(topic) = &self.topics.map_topic {
            recording.prefer(Kind::Map, topic)?;
        }
        map_in(&recording)
    }

    /// Opens a recording, or several files of one.
    ///
    /// # Errors
    /// It cannot be read, or has no channel that is named.
    pub fn open(&self, paths: &[PathBuf]) -> Result<Recording, OfflineError> {
        let mut recording = Recording::open_all(paths)?;
        // Where the map is another's, so is its channel.
        let map_topic = self
            .topics
            .map_topic
            .clone()
            .filter(|_| self.map.is_empty());
        let topics = TopicOptions {
            map_topic,
            ..self.topics.clone()
        };
        topics.apply(&mut recording)?;
        Ok(recording)
    }
}

/// Whether it is named as a map is, and is no recording.
fn is_map(path: &Path) -> bool {
    let endings = ["yaml", "yml", "pgm", "png", "bmp"];
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| endings.contains(&ending)) && !recording::is_recording(path)
}
