//! Command-line options.

use clap::Parser;
use engine::grid::CellRules;

/// Finds the obstacle cells of `map` that a laser can hit and publishes them as
/// `boundary`.
#[derive(Debug, Clone, Parser)]
#[command(name = "boundary_extractor", version)]
pub struct Config {
    /// How the occupancy of a cell is read.
    #[command(flatten)]
    pub rules: CellRules,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn parse(arguments: &str) -> Result<CellRules, String> {
        let words = ["boundary_extractor"]
            .into_iter()
            .chain(arguments.split_whitespace());
        Config::try_parse_from(words)
            .map(|config| config.rules)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_command_line_is_well_formed() {
        Config::command().debug_assert();
    }

    #[test]
    fn rules_have_defaults_and_limits() {
        assert_eq!(parse(""), Ok(CellRules::default()));
        let rules = parse("--occupied-from 50 --free-to 10 --unknown-blocks").unwrap();
        assert_eq!(
            (rules.occupied_from, rules.free_to, rules.unknown_blocks),
            (50, 10, true)
        );
        assert!(parse("--occupied-from 0").unwrap_err().contains("1..=100"));
        assert!(parse("--free-to 100").unwrap_err().contains("0..=99"));
    }
}
