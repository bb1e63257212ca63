//! Commands that do not need a running graph, with the feature `tools`.

use std::process::ExitCode;

use clap::Subcommand;
use evaluation::{evaluate, locate, regression};
use recording_tools::{convert, doctor, info, simulate};

use super::{EXIT_CODES, end, shell};
use crate::{init, probe, top};

/// Commands that work with recordings.
#[derive(Debug, Subcommand)]
pub(crate) enum OnRecordings {
    /// Finds the place of each scan of a recording, in one process
    #[command(after_help = EXIT_CODES)]
    Locate(locate::Config),
    /// Compares the places found with the true poses in recordings
    #[command(after_help = evaluate::NOTES)]
    Evaluate(Box<evaluate::Config>),
    /// Draws a map, a scan at its places, votes or errors, as PNG or SVG
    #[command(after_help = plots::NOTES)]
    Plot(plots::Config),
    /// Lists the contents of a recording
    #[command(after_help = EXIT_CODES)]
    Info(info::Config),
    /// Checks a recording for problems
    #[command(after_help = doctor::NOTES)]
    Doctor(doctor::Config),
    /// Converts laser logs of CARMEN and bags in SQLite to recordings
    #[command(after_help = convert::NOTES)]
    Convert(convert::Config),
    /// Replays recordings through the graph and compares the poses with expected ones
    #[command(after_help = regression::NOTES)]
    Regress(regression::Config),
}

/// Commands for running graphs, lasers and generated worlds.
#[derive(Debug, Subcommand)]
pub(crate) enum OnTheSide {
    /// Shows a running graph in the terminal
    #[command(after_help = EXIT_CODES)]
    Top(top::Config),
    /// Writes the descriptor of a graph for a laser, a ROS 2 robot or a recording
    #[command(after_help = init::NOTES)]
    Init(init::Config),
    /// Shows which laser is connected, its settings and what it sees
    #[command(after_help = probe::NOTES)]
    Probe(probe::Config),
    /// Measures the methods of global localization on generated worlds
    #[command(after_help = bench::NOTES)]
    Bench(bench::Config),
    /// Records a drive through a map as a laser or a ring of sonars would see it
    #[command(after_help = "Exit codes: 0 recorded, 1 failed, 2 wrong use")]
    Simulate(Box<simulate::Config>),
    /// Prints the completions of a shell
    Completions(shell::CompletionsConfig),
    /// Writes manual pages
    #[command(hide = true)]
    Man(shell::ManConfig),
}

impl OnRecordings {
    pub(crate) fn run(&self) -> ExitCode {
        match self {
            Self::Locate(config) => end(locate::run(config)),
            Self::Evaluate(config) => end(evaluate::run(config)),
            Self::Plot(config) => end(plots::run(config)),
            Self::Info(config) => end(info::run(config)),
            Self::Doctor(config) => doctor(config),
            Self::Convert(config) => end(convert::run(config)),
            Self::Regress(config) => end(regression::run(config)),
        }
    }
}

fn doctor(config: &doctor::Config) -> ExitCode {
    let Some((router, length)) = config.live() else {
        return end(doctor::run(config));
    };
    match init::record(router, length) {
        Ok(recorded) => end(doctor::run_on(config, &recorded.file, &recorded.warnings)),
        Err(error) => end(Err(error)),
    }
}

impl OnTheSide {
    pub(crate) fn run(&self) -> ExitCode {
        match self {
            Self::Top(config) => end(top::run(config)),
            Self::Probe(config) => end(probe::run(config)),
            Self::Bench(config) => end(bench::run(config)),
            Self::Simulate(config) => end(simulate::run(config)),
            Self::Init(config) => end(init::run(config)),
            Self::Completions(config) => end(shell::completions(config)),
            Self::Man(config) => end(shell::man(config)),
        }
    }
}
