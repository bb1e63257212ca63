//! Command-line options.

use clap::Parser;

/// Finds the obstacle cells of `map` that a laser can hit and publishes them as
/// `boundary`.
#[derive(Debug, Clone, Parser)]
#[command(name = "boundary_extractor", version)]
pub struct Config {}
