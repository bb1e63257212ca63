//! Command-line options.

use clap::Parser;
use command_line::settings::{self, SettingsFile};
use engine::peaks::PeakConfig;

use crate::ParticlesConfig;

/// Combines the votes of each scan into distinct poses with a verdict and publishes them as
/// `hypotheses`.
#[derive(Debug, Clone, Parser)]
#[command(name = "peak_extractor", version)]
pub struct Config {
    #[command(flatten)]
    pub file: SettingsFile,
    /// Rules for combining votes into places, and for the verdict.
    #[command(flatten)]
    pub peaks: PeakConfig,
    #[command(flatten)]
    pub particles: ParticlesConfig,
}

impl Config {
    /// Parses the command line; exits with code 2 if it is invalid.
    #[must_use]
    pub fn from_command_line() -> Self {
        settings::parse(|config: &Config| &config.file, |_| Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(arguments: &str) -> Result<PeakConfig, String> {
        let words = ["peak_extractor"]
            .into_iter()
            .chain(arguments.split_whitespace());
        Config::try_parse_from(words)
            .map(|config| config.peaks)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn settings_have_defaults_and_limits() {
        assert_eq!(parse(""), Ok(PeakConfig::default()));
        let config = parse("--max-hypotheses 3 --same-place-m 0.3").unwrap();
        assert_eq!((config.max_hypotheses, config.same_place_m), (3, 0.3));
        assert!(
            parse("--max-hypotheses 0")
                .unwrap_err()
                .contains("1..=1000")
        );
        assert!(parse("--same-place-m -1").is_err());
        assert!(parse("--particles 0").is_err());
    }
}
