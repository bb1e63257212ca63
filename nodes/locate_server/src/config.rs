//! Command-line options.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use clap::builder::TypedValueParser;
use command_line::number;
use engine::directions::Directions;
use engine::grid::CellRules;
use engine::peaks::PeakConfig;
use engine::vote_search::VoteSearchConfig;
use map::{MapError, MapFile, MapSet};

/// Locates scans on a map, for clients on Zenoh.
///
/// Listens on this machine only by default. Any number of servers may answer for one map; each
/// passes on the requests for which it has no free worker.
#[derive(Debug, Clone, Parser)]
#[command(name = "locate_server", version)]
pub struct Config {
    /// Map, a YAML file in the format of map_server; several maps are searched together
    #[arg(long, value_name = "FILE", required_unless_present = "maps")]
    pub map: Vec<PathBuf>,

    /// Maps of a building, searched together: a folder of maps, or a file that lists them with
    /// names and floors
    #[arg(long, value_name = "FOLDER|FILE", conflicts_with = "map")]
    pub maps: Option<PathBuf>,

    /// Load only these maps of several, by the names of maps or floors
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    pub on: Vec<String>,

    /// Name of the map or the set of maps, the last part of backcast/locate/NAME: 1 to 64 of a-z
    /// A-Z 0-9 - _ . [default: the name of the map's folder]
    #[arg(long, value_name = "NAME", value_parser = network_payload::name)]
    pub name: Option<String>,

    /// Number of scans that are searched in parallel, 1 to 256 [default: one per core]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub workers: Option<u16>,

    /// Number of scans that may wait for each worker, 0 to 1000; further ones are answered with
    /// "busy"
    #[arg(long, value_name = "COUNT", default_value_t = 4, value_parser = clap::value_parser!(u16).range(0..=1000))]
    pub waiting: u16,

    /// Timeout of a request that names none, 0.01 to 60 seconds; a scan that cannot be answered in
    /// time is not searched
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = number(0.01..=60.0, "seconds").map(Duration::from_secs_f64))]
    pub deadline: Duration,

    #[command(flatten)]
    pub(crate) network: zenoh_session::Options,

    #[command(flatten)]
    pub(crate) cells: CellRules,

    #[command(flatten)]
    pub(crate) vote_search: VoteSearchConfig,

    #[command(flatten)]
    pub(crate) peaks: PeakConfig,
}

impl Config {
    pub fn from_command_line() -> Self {
        command_line::parse(|config: &Config| {
            let headings = Directions::new(config.vote_search.headings);
            headings.map(drop).map_err(|problem| problem.to_string())
        })
    }

    pub fn files(&self) -> Result<Vec<MapFile>, MapError> {
        let all = match (&self.maps, &*self.map) {
            (Some(set), _) => map::set_of_noting(set, |line| tracing::info!("{line}")),
            // A single map needs no name of its own.
            (None, [yaml]) => Ok(MapSet {
                maps: vec![MapFile {
                    name: self.name(),
                    yaml: yaml.clone(),
                    floor: None,
                }],
                transitions: Vec::new(),
            }),
            (None, files) => map::set_of_files(files),
        };
        Ok(all?.select(&self.on)?.maps)
    }

    pub fn name(&self) -> String {
        let folder = || {
            let path = self.maps.as_ref().or(self.map.first())?;
            let path = path.canonicalize().ok()?;
            let folder = if path.is_dir() { &path } else { path.parent()? };
            let folder = folder.file_name()?.to_str()?.to_owned();
            network_payload::name(&folder).ok()
        };
        let given = self.name.clone().or_else(folder);
        given.unwrap_or_else(|| "map".to_owned())
    }

    pub fn workers(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.workers.map_or_else(cores, usize::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["locate_server", "--map", "maps/office/map.yaml"].into_iter();
        Config::try_parse_from(words.chain(arguments.split_whitespace()))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_command_line_is_well_formed() {
        let config = parse("--name office --workers 3 --deadline 0.5").unwrap();
        assert_eq!((config.name().as_str(), config.workers()), ("office", 3));
        assert_eq!(config.deadline, Duration::from_millis(500));
        assert_eq!(config.vote_search, VoteSearchConfig::default());
    }

    #[test]
    fn only_the_maps_that_are_named_are_held() {
        let held = |on: &str| {
            let config = parse(&format!("--map b/y.yaml --map c/z.yaml --on {on}"));
            config.unwrap().files()
        };
        let names = held("z,y").unwrap().into_iter().map(|map| map.name);
        assert_eq!(names.collect::<Vec<_>>(), ["y", "z"]);
        let error = held("x").unwrap_err().to_string();
        assert!(error.contains("y, z"), "{error}");
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("--name a/b", "1 to 64 of a-z A-Z 0-9 - _ .");
        refuse("--deadline 0", "0.01 to 60 seconds");
        refuse("--deadline NaN", "0.01 to 60 seconds");
        refuse("--workers 0", "1..=256");
    }
}
