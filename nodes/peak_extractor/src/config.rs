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
    pub fn from_command_line() -> Self {
        settings::parse(|config: &Config| &config.file, |_| Ok(()))
    }
}
