//! Options of `locate`, `evaluate` and `plot`.

use std::path::{Path, PathBuf};

use command_line::{say, wrong_use};
use engine::directions::Directions;
use engine::grid::CellRules;
use engine::heading::HeadingConfig;
use engine::joined::MotionConfig;
use engine::peaks::PeakConfig;
use engine::vote_search::VoteSearchConfig;
use index_cache::IndexCacheConfig;
use map::OccupancyGrid;
use recording::{Kind, Recording};

use super::maps::map_in;
use super::topics::TopicOptions;

/// Map, selection of scans, and settings of the search.
#[derive(Debug, Clone, clap::Args)]
pub struct Options {
    /// The map, a YAML file in the format of map_server, or another recording that contains one;
    /// `locate` searches several together if it is given several times [default: in the recording,
    /// the newest before each scan]
    #[arg(long, value_name = "FILE")]
    pub map: Vec<PathBuf>,

    #[command(flatten)]
    pub topics: TopicOptions,

    /// Take every N-th scan, starting with the first; 1 takes all
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub every: u64,

    #[command(flatten)]
    pub heading: HeadingConfig,

    #[command(flatten)]
    pub motion: MotionConfig,

    #[command(flatten)]
    pub engine: EngineOptions,

    #[command(flatten, next_help_heading = "Kept maps")]
    pub index_cache: IndexCacheConfig,
}

#[derive(Debug, Clone, PartialEq)]
pub struct NamedMap {
    pub name: String,
    /// Floor, if the map set defines it.
    pub floor: Option<String>,
    pub grid: OccupancyGrid,
}

/// All settings of the engine, the same as those of the graph's nodes.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Engine")]
pub struct EngineOptions {
    #[command(flatten)]
    pub cells: CellRules,
    #[command(flatten)]
    pub vote_search: VoteSearchConfig,
    #[command(flatten)]
    pub peaks: PeakConfig,
}

impl Options {
    /// Checks relations between options, and that there is at most one map; opens no file.
    /// Errors name the option and what is allowed.
    pub fn check(&self) -> anyhow::Result<()> {
        let maps = self.map.len();
        if maps > 1 {
            return Err(wrong_use(format!(
                "--map is given {maps} times: only `backcast locate` searches several maps"
            )));
        }
        self.check_settings()
    }

    /// Like [`Options::check`], but allows several maps.
    /// Errors name the option and what is allowed.
    pub fn check_settings(&self) -> anyhow::Result<()> {
        let headings = Directions::new(self.engine.vote_search.headings);
        headings.map_err(|error| wrong_use(error.to_string()))?;
        self.heading.check().map_err(wrong_use)
    }

    pub fn with_map(&self, file: &Path) -> Self {
        Options {
            map: vec![file.to_owned()],
            ..self.clone()
        }
    }

    /// Loads the map of `--map`. `recordings` help to detect that map and recording were swapped.
    pub fn load_map(&self, recordings: &[PathBuf]) -> anyhow::Result<Option<OccupancyGrid>> {
        let file = self.map.first();
        file.map(|file| self.load(file, recordings)).transpose()
    }

    /// Loads several maps: those given by `--map`, or those of a set, which is a folder or a file
    /// that lists them; empty if there are not several. `on` selects maps by the names of maps or
    /// floors.
    /// Fails if a map or the set cannot be read, or it contains no map and no floor of a name in
    /// `on`.
    pub fn load_set(
        &self,
        set: Option<&Path>,
        on: &[String],
        recordings: &[PathBuf],
    ) -> anyhow::Result<Vec<NamedMap>> {
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

    fn load(&self, file: &Path, recordings: &[PathBuf]) -> anyhow::Result<OccupancyGrid> {
        map::check_kind(file)?;
        if !recording::is_recording(file) {
            let grid = map::load_within(map::MemoryLimit::NONE, file, |key| say(&key.to_string()))?;
            return Ok(grid);
        }
        if let Some(other) = recordings.iter().find(|path| is_map(path)) {
            let (other, file) = (other.display(), file.display());
            return Err(wrong_use(format!(
                "{other} is a map, and --map {file} a recording: the two look swapped"
            )));
        }
        let mut recording = Recording::open(file)?;
        if let Some(topic) = &self.topics.map_topic {
            recording.prefer(Kind::Map, topic)?;
        }
        map_in(&recording)
    }

    /// Separates maps, for the options, from recordings; if all look like maps, all are recordings.
    pub fn sorted(&self, files: &[PathBuf]) -> (Self, Vec<PathBuf>) {
        let (maps, recordings): (Vec<_>, Vec<_>) = files.iter().cloned().partition(|f| is_map(f));
        let mut options = self.clone();
        if recordings.is_empty() {
            return (options, maps);
        }
        options.map.extend(maps);
        (options, recordings)
    }

    /// Opens a recording, which may consist of several files.
    pub fn open(&self, paths: &[PathBuf]) -> anyhow::Result<Recording> {
        let mut recording = Recording::open_all(paths)?;
        // With `--map`, the map's topic belongs to that file.
        let map_topic = self.topics.map_topic.clone();
        let map_topic = map_topic.filter(|_| self.map.is_empty());
        let topics = TopicOptions {
            map_topic,
            ..self.topics.clone()
        };
        topics.apply(&mut recording)?;
        Ok(recording)
    }
}

/// True if the file looks like a map, and is not a recording.
fn is_map(path: &Path) -> bool {
    let endings = ["yaml", "yml", "pgm", "png", "bmp"];
    let ending = path.extension().and_then(|ending| ending.to_str());
    let is_ended = ending.is_some_and(|ending| endings.contains(&ending));
    map::check_kind(path).is_err() || (is_ended && !recording::is_recording(path))
}
