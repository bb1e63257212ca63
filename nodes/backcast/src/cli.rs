//! The command line: reads it, calls the command, picks the exit code.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::{
    bench, check, control, convert, doctor, evaluate, info, locate, plot, probe, regress, run,
    simulate, soak, top,
};

/// Finds where a robot is from its laser and a map, with no initial guess.
///
/// Without a command, `run` is meant: `backcast --rate max` is `backcast run
/// --rate max`.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: run::Options,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 wrong use, 3 done but data was lost";

/// One variant a command.
#[derive(Debug, Subcommand)]
enum Command {
    /// Builds and starts the graph, and prints a pose for each scan
    #[command(after_help = EXIT_CODES)]
    Run(run::Config),
    /// Says what is wrong with a graph's descriptor, or draws the graph
    #[command(after_help = "Exit codes: 0 sound, 1 something is wrong, 2 wrong use")]
    Check(check::Config),
    /// Finds the place of each scan of a recording, in one process
    #[command(after_help = EXIT_CODES)]
    Locate(locate::Config),
    /// Judges the places that are found against the truth in recordings
    #[command(after_help = evaluate::NOTES)]
    Evaluate(Box<evaluate::Config>),
    /// Draws a map, a scan at its places, votes or errors, as PNG or SVG
    #[command(after_help = plot::NOTES)]
    Plot(plot::Config),
    /// Lists what a recording holds
    #[command(after_help = EXIT_CODES)]
    Info(info::Config),
    /// Says what is wrong with a recording
    #[command(after_help = doctor::NOTES)]
    Doctor(doctor::Config),
    /// Converts laser logs of CARMEN and bags in SQLite to recordings, and back to logs
    #[command(after_help = convert::NOTES)]
    Convert(convert::Config),
    /// Replays recordings through the graph and compares with what is expected
    #[command(after_help = regress::NOTES)]
    Regress(regress::Config),
    /// Lists the graphs that run, with the state of their nodes
    #[command(after_help = EXIT_CODES)]
    Status(control::StatusConfig),
    /// Stops a running graph in order
    #[command(after_help = EXIT_CODES)]
    Stop(control::StopConfig),
    /// Ends one node of a running graph in order and starts it again
    #[command(after_help = EXIT_CODES)]
    Restart(control::RestartConfig),
    /// Shows what the nodes of a running graph log
    #[command(after_help = EXIT_CODES)]
    Logs(control::LogsConfig),
    /// Runs a graph for long, does it harm, and says whether it kept its promises
    #[command(after_help = soak::NOTES)]
    Soak(soak::Config),
    /// Shows a running graph in the terminal
    #[command(after_help = EXIT_CODES)]
    Top(top::Config),
    /// Says which laser is there, how it is set and what it sees
    #[command(after_help = probe::NOTES)]
    Probe(probe::Config),
    /// Measures the methods of global localization on generated worlds
    #[command(after_help = bench::NOTES)]
    Bench(bench::Config),
    /// Records a drive through a map as a laser or a ring of sonars would see it
    #[command(after_help = "Exit codes: 0 recorded, 1 failed, 2 wrong use")]
    Simulate(Box<simulate::Config>),
}

/// Runs the command that the process was started with.
#[must_use]
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match cli.command {
        None => run::run(&run::Config::with(cli.run)),
        Some(Command::Run(config)) => run::run(&config),
        Some(Command::Check(config)) => check::run(&config),
        Some(Command::Locate(config)) => locate::run(&config),
        Some(Command::Evaluate(config)) => evaluate::run(&config),
        Some(Command::Plot(config)) => plot::run(&config),
        Some(Command::Info(config)) => info::run(&config),
        Some(Command::Doctor(config)) => doctor::run(&config),
        Some(Command::Convert(config)) => convert::run(&config),
        Some(Command::Regress(config)) => regress::run(&config),
        Some(Command::Status(config)) => control::status(&config),
        Some(Command::Stop(config)) => control::stop(&config),
        Some(Command::Restart(config)) => control::restart(&config),
        Some(Command::Logs(config)) => control::logs(&config),
        Some(Command::Soak(config)) => soak::run(&config),
        Some(Command::Top(config)) => top::run(&config),
        Some(Command::Probe(config)) => probe::run(&config),
        Some(Command::Bench(config)) => bench::run(&config),
        Some(Command::Simulate(config)) => simulate::run(&config),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("backcast: {}", transport::with_causes(&error));
        ExitCode::from(error.exit_code())
    })
}

/// The exit code of what was started with the wrong options or settings.
pub(crate) const WRONG_USE: u8 = 2;
/// The exit code of a run that finished but lost data on the way.
pub(crate) const LOST_DATA: u8 = 3;

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn parse(line: &str) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(line.split_whitespace())
    }

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn options_of_run_need_no_command() {
        let cli = parse("backcast --rate max --loop").unwrap();
        assert!(cli.command.is_none());
        assert!(cli.run.repeat);
        assert!(matches!(
            parse("backcast run other.yaml --rate 2.5").unwrap().command,
            Some(Command::Run(_))
        ));
    }

    #[test]
    fn nonsense_is_refused() {
        for line in [
            "backcast chekc",
            "backcast --rate 0",
            "backcast --rate -1",
            "backcast --rate nan",
            "backcast --rate inf",
            "backcast --rate fast",
            "backcast --heading north",
            "backcast --heading inf",
            "backcast --heading -361",
            "backcast --heading 10 --heading-from odometry",
            "backcast --heading-from compass",
            "backcast --graph Big",
            "backcast --rate 2 check",
            "backcast plot",
            "backcast plot --bag r.mcap",
            "backcast plot histogram --out p.png",
            "backcast plot --out p.png --scan 0",
            "backcast plot --out p.png --width 199",
            "backcast plot sheet --out p.png --panels 65",
            "backcast bench",
            "backcast bench table3",
            "backcast bench search --kind caves",
            "backcast bench search --size 31",
            "backcast bench search --size 5001",
            "backcast bench table1 --p-over-n 0",
            "backcast bench table1 --noise 26",
            "backcast bench table2 --headings 361",
            "backcast soak --minutes 0",
            "backcast soak --minutes 1 --hours 1",
            "backcast soak --faults kill,quake",
            "backcast simulate --map m.yaml --path 0,0 --out r.mcap",
            "backcast simulate --map m.yaml --path 0,0,1,1 --out r.mcap --beams 1",
        ] {
            let error = parse(line).expect_err(line);
            assert_eq!(error.exit_code(), 2, "{line}");
        }
    }
}
