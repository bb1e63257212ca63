//! Command-line options.

use clap::Parser;
use command_line::number;
use command_line::settings::{self, SettingsFile};
use engine::directions::Directions;
use engine::heading::HeadingConfig;
use engine::joined::JoinConfig;
use engine::vote_search::{Prior, VoteSearchConfig};
use index_cache::IndexCacheConfig;

use crate::sonar::regions::SonarConfig;

/// Largest number of votes in a message, for which readers of `votes` are built.
const MAX_VOTES: u32 = 65_536;

/// Default work limit in millions of steps, about five seconds.
const WORK_LIMIT: f64 = 5_000.0;

/// Searches the poses at which each scan fits the map and publishes them as
/// `votes`.
#[derive(Debug, Clone, Parser)]
#[command(name = "accumulator", version)]
pub struct Config {
    #[command(flatten)]
    pub file: SettingsFile,

    #[command(flatten)]
    pub vote_search: VoteSearchConfig,

    #[command(flatten)]
    pub index_cache: IndexCacheConfig,

    #[command(flatten)]
    pub heading: HeadingConfig,

    #[command(flatten)]
    pub join: JoinConfig,

    #[command(flatten)]
    pub sonar: SonarConfig,

    /// Scans to search.
    #[arg(long, value_enum, default_value_t = Searched::All)]
    pub search: Searched,

    /// Maximum number of images per second on `field`, 0.1..=100. They are sent while the topic has
    /// a subscriber: the intensities of all cells if the heading is known, else the upper bound for
    /// each block of cells.
    #[arg(long, value_name = "HERTZ", default_value_t = 2.0, value_parser = number(0.1..=100.0, "images a second"))]
    pub field_rate: f64,
}

/// Selection of the scans that are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Searched {
    /// Every scan.
    All,
    /// Scans that `attention` asks for, of the last 64.
    Asked,
}

impl Config {
    pub fn from_command_line() -> Self {
        settings::parse(|config: &Config| &config.file, Config::check)
    }

    /// Returns the settings of the localizer, with a default work limit against clutter.
    pub(crate) fn vote_search(&self) -> VoteSearchConfig {
        let mut vote_search = self.vote_search.clone();
        vote_search.collect.work_limit.get_or_insert(WORK_LIMIT);
        vote_search
    }

    /// Returns the prior knowledge of the heading: none, or a known heading.
    pub fn prior(&self) -> Prior {
        self.heading.source().prior()
    }

    fn check(&self) -> Result<(), String> {
        Directions::new(self.vote_search.headings).map_err(|error| error.to_string())?;
        let max_votes = self.vote_search.collect.max_votes;
        if max_votes > MAX_VOTES {
            return Err(format!(
                "--max-votes is {max_votes}: a message of `votes` holds at most {MAX_VOTES}"
            ));
        }
        if self.join.scans.len() > 1 && self.sonar.sonar_way.is_some() {
            return Err(
                "--scans joins lasers and --sonar-way reads one ring of sonars: \
                        allowed is one of them"
                    .into(),
            );
        }
        if self.search == Searched::Asked && self.sonar.sonar_way.is_some() {
            return Err(
                "--search asked and --sonar-way: a ring of sonars is searched with each scan"
                    .into(),
            );
        }
        self.heading.check()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["accumulator"]
            .into_iter()
            .chain(arguments.split_whitespace());
        let config = Config::try_parse_from(words).map_err(|error| error.to_string())?;
        config.check().map(|()| config)
    }

    #[test]
    fn all_headings_are_searched_unless_one_is_known() {
        let config = parse("").unwrap();
        assert_eq!(config.vote_search, VoteSearchConfig::default());
        assert_eq!(config.prior(), Prior::None);
        assert_eq!(parse("--heading 0").unwrap().prior(), Prior::Heading);
        assert!(config.sonar.window().is_none());
        assert_eq!(config.vote_search().collect.work_limit, Some(WORK_LIMIT));
        let endless = parse("--work-limit 0").unwrap().vote_search();
        assert_eq!(endless.collect.work_limit, Some(0.0));
        let sonar = parse("--sonar-way 2 --sonar-cone 25").unwrap().sonar;
        assert_eq!((sonar.sonar_way, sonar.sonar_cone), (Some(2.0), 25.0));
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("--heading-offset 10", "needs --heading-from odometry");
        refuse("--sonar-cone 20", "--sonar-way");
        refuse("--sonar-way 0", "0.1 to 5 metres");
        refuse("--field-rate 0", "0.1 to 100 images a second");
        refuse("--headings 100", "multiple of 8");
        refuse("--max-votes 65537", "at most 65536");
        refuse("--scans front,rear --sonar-way 2", "one of them");
        refuse("--search asked --sonar-way 2", "with each scan");
        refuse("--odometry-delay-s 2", "-1 to 1 seconds");
    }
}
