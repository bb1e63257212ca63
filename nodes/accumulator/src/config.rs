//! What a user can set.

use clap::{CommandFactory, Parser, ValueEnum, error::ErrorKind};
use engine::directions::Directions;
use engine::localizer::{LocalizerConfig, Prior};

use crate::headings::HeadingSource;

/// Most votes in a message: what the readers of `votes` are made for.
const MAX_VOTES: u32 = 65_536;

/// Searches the poses at which each scan fits the map and publishes them as
/// `votes`.
#[derive(Debug, Clone, Parser)]
#[command(name = "accumulator", version)]
pub struct Config {
    /// How scans are matched with the map.
    #[command(flatten)]
    pub localizer: LocalizerConfig,

    /// What is known of the heading.
    #[command(flatten)]
    pub heading: HeadingConfig,

    /// Most images on `field` a second, 0.1..=100. They are sent while somebody
    /// subscribes: the intensities of all cells where the heading is known, else
    /// the most that any pose in a block of cells could have.
    #[arg(long, value_name = "HERTZ", default_value_t = 2.0, value_parser = field_rate)]
    pub field_rate: f64,
}

/// What is known of the heading. With nothing given, all headings are searched.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct HeadingConfig {
    /// The laser's heading in the map, degrees, -360..=360: only x and y are
    /// searched.
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_hyphen_values = true)]
    #[arg(conflicts_with = "heading_from")]
    pub heading: Option<f64>,

    /// Where each scan's heading comes from: only x and y are searched.
    #[arg(long, value_enum, value_name = "SOURCE")]
    pub heading_from: Option<HeadingFrom>,

    /// Added to the heading from odometry, degrees, -360..=360: the heading in
    /// the map where odometry says 0. Odometry drifts, so this serves the start
    /// of a run. 0 where it is not given.
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_hyphen_values = true)]
    pub heading_offset: Option<f64>,

    /// Odometry that was measured longer before its scan is not used, seconds,
    /// 0..=60. 1 where it is not given.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub heading_max_age_s: Option<f64>,
}

/// A topic that headings come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum HeadingFrom {
    /// The newest `odometry` that was measured before the scan.
    Odometry,
    /// The `ground_truth` of the scan, sent before it; for tests.
    Truth,
}

impl Config {
    /// Reads the command line; ends the process with code 2 where it is wrong.
    #[must_use]
    pub fn from_command_line() -> Self {
        let config = Config::parse();
        match config.check() {
            Ok(()) => config,
            Err(problem) => Config::command()
                .error(ErrorKind::ValueValidation, problem)
                .exit(),
        }
    }

    /// Whether the localizer has to search the heading.
    #[must_use]
    pub fn prior(&self) -> Prior {
        match self.heading.source() {
            HeadingSource::Searched => Prior::None,
            _ => Prior::Heading,
        }
    }

    /// Checks what no option can check alone.
    fn check(&self) -> Result<(), String> {
        Directions::new(self.localizer.headings).map_err(|error| error.to_string())?;
        let max_votes = self.localizer.collect.max_votes;
        if max_votes > MAX_VOTES {
            return Err(format!(
                "--max-votes is {max_votes}: a message of `votes` holds at most {MAX_VOTES}"
            ));
        }
        self.heading.check()
    }
}

impl HeadingConfig {
    /// Where headings come from, in radians and nanoseconds.
    #[must_use]
    pub fn source(&self) -> HeadingSource {
        match (self.heading, self.heading_from) {
            (Some(degrees), _) => HeadingSource::Fixed(degrees.to_radians()),
            (None, None) => HeadingSource::Searched,
            (None, Some(HeadingFrom::Truth)) => HeadingSource::Truth,
            (None, Some(HeadingFrom::Odometry)) => HeadingSource::Odometry {
                offset: self.heading_offset.unwrap_or(0.0).to_radians(),
                max_age_ns: (self.heading_max_age_s.unwrap_or(1.0) * 1e9) as i64,
            },
        }
    }

    /// clap lets an option's requirement go where something else excludes it,
    /// as `--heading` does here.
    fn check(&self) -> Result<(), String> {
        if self.heading_from == Some(HeadingFrom::Odometry) {
            return Ok(());
        }
        let options = [
            ("--heading-offset", self.heading_offset),
            ("--heading-max-age-s", self.heading_max_age_s),
        ];
        match options.iter().find(|(_, value)| value.is_some()) {
            Some((option, _)) => Err(format!("{option} needs --heading-from odometry")),
            None => Ok(()),
        }
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    number_within(text, -360.0..=360.0, "degrees")
}

fn seconds(text: &str) -> Result<f64, String> {
    number_within(text, 0.0..=60.0, "seconds")
}

fn field_rate(text: &str) -> Result<f64, String> {
    number_within(text, 0.1..=100.0, "images a second")
}

fn number_within(
    text: &str,
    allowed: std::ops::RangeInclusive<f64>,
    unit: &str,
) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if allowed.contains(&number) => Ok(number),
        _ => Err(format!(
            "allowed are {} to {} {unit}",
            allowed.start(),
            allowed.end()
        )),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn parse(arguments: &str) -> Result<Config, String> {
        let words = ["accumulator"]
            .into_iter()
            .chain(arguments.split_whitespace());
        let config = Config::try_parse_from(words).map_err(|error| error.to_string())?;
        config.check().map(|()| config)
    }

    fn source(arguments: &str) -> HeadingSource {
        parse(arguments).unwrap().heading.source()
    }

    #[test]
    fn the_command_line_is_well_formed() {
        Config::command().debug_assert();
    }

    #[test]
    fn all_headings_are_searched_unless_one_is_known() {
        let config = parse("").unwrap();
        assert_eq!(config.localizer, LocalizerConfig::default());
        assert_eq!(config.heading.source(), HeadingSource::Searched);
        assert_eq!(config.prior(), Prior::None);
        assert_eq!(parse("--heading 0").unwrap().prior(), Prior::Heading);
    }

    #[test]
    fn headings_are_given_in_degrees() {
        assert_eq!(source("--heading -90"), HeadingSource::Fixed(-FRAC_PI_2));
        assert_eq!(source("--heading-from truth"), HeadingSource::Truth);
        assert_eq!(
            source("--heading-from odometry"),
            HeadingSource::Odometry {
                offset: 0.0,
                max_age_ns: 1_000_000_000
            }
        );
        assert_eq!(
            source("--heading-from odometry --heading-offset -90 --heading-max-age-s 0.25"),
            HeadingSource::Odometry {
                offset: -FRAC_PI_2,
                max_age_ns: 250_000_000
            }
        );
    }

    #[test]
    fn what_is_refused_says_what_is_allowed() {
        let refuse = |arguments: &str, expected: &str| {
            let text = parse(arguments).unwrap_err();
            assert!(text.contains(expected), "{arguments}: {text}");
        };
        refuse("--heading 10 --heading-from truth", "cannot be used with");
        let needs_odometry = [
            "--heading-offset 10",
            "--heading-max-age-s 1",
            "--heading 1 --heading-offset 10",
            "--heading-from truth --heading-offset 0",
            "--heading-from truth --heading-max-age-s 1",
        ];
        for arguments in needs_odometry {
            refuse(arguments, "needs --heading-from odometry");
        }
        refuse("--heading NaN", "-360 to 360 degrees");
        refuse(
            "--heading-from odometry --heading-max-age-s 61",
            "0 to 60 seconds",
        );
        refuse("--heading-from gps", "odometry, truth");
        refuse("--field-rate 0", "0.1 to 100 images a second");
        refuse("--headings 100", "multiple of 8");
        refuse("--max-votes 65537", "at most 65536");
    }
}
