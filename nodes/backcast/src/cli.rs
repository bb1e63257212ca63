//! Command line: parses it, calls the command, and chooses the exit code.

#[cfg(feature = "tools")]
mod shell;
#[cfg(feature = "tools")]
mod tools;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use command_line::exit_code;
use launcher::{check, control, run};

#[cfg(feature = "tools")]
use tools::{OnRecordings, OnTheSide};

/// Finds where a robot is from its laser and a map, with no initial guess.
///
/// Without a command, `run` is assumed: `backcast --rate max` is `backcast run --rate max`.
#[derive(Debug, Parser)]
#[command(version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: run::Options,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 wrong use, 3 done but data was lost";

/// Commands, in the order of the help text.
#[derive(Debug, Subcommand)]
enum Command {
    /// Builds and starts the graph, and prints a pose for each scan
    #[command(after_help = EXIT_CODES)]
    Run(Box<run::Config>),
    /// Checks a graph's descriptor, or draws the graph
    #[command(after_help = "Exit codes: 0 sound, 1 something is wrong, 2 wrong use")]
    Check(check::Config),
    #[cfg(feature = "tools")]
    #[command(flatten)]
    OnRecordings(Box<OnRecordings>),
    /// Lists the running graphs, with the state of their nodes
    #[command(after_help = EXIT_CODES)]
    Status(control::StatusConfig),
    /// Stops a running graph
    #[command(after_help = EXIT_CODES)]
    Stop(control::OneGraph),
    /// Restarts one node of a running graph
    #[command(after_help = EXIT_CODES)]
    Restart(control::RestartConfig),
    /// Starts or stops a recording of a running graph
    #[command(after_help = EXIT_CODES)]
    Record(control::RecordConfig),
    /// Shows the log of a running graph
    #[command(after_help = EXIT_CODES)]
    Logs(control::LogsConfig),
    #[cfg(feature = "tools")]
    #[command(flatten)]
    OnTheSide(Box<OnTheSide>),
}

pub fn main() -> ExitCode {
    let cli = Cli::parse();
    match cli.command {
        None => end(run::run(&run::Config::with(cli.run))),
        Some(Command::Run(config)) => end(run::run(&config)),
        Some(Command::Check(config)) => end(check::run(&config)),
        #[cfg(feature = "tools")]
        Some(Command::OnRecordings(tool)) => tool.run(),
        Some(Command::Status(config)) => end(control::status(&config)),
        Some(Command::Stop(graph)) => end(control::stop(&graph)),
        Some(Command::Restart(config)) => end(control::restart(&config)),
        Some(Command::Record(config)) => end(control::record(&config)),
        Some(Command::Logs(config)) => end(control::logs(&config)),
        #[cfg(feature = "tools")]
        Some(Command::OnTheSide(tool)) => tool.run(),
    }
}

/// Prints the error of a failed command on standard error; returns the exit code.
fn end(outcome: anyhow::Result<ExitCode>) -> ExitCode {
    outcome.unwrap_or_else(|error| {
        eprintln!("backcast: {error:#}");
        ExitCode::from(exit_code(&error))
    })
}

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
        check_refused(&[
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
        ]);
    }

    #[cfg(feature = "tools")]
    #[test]
    fn nonsense_for_tools_is_refused() {
        check_refused(&[
            "backcast plot",
            "backcast bench",
            "backcast bench table3",
            "backcast bench search --kind caves",
            "backcast bench search --size 31",
            "backcast bench search --size 5001",
            "backcast bench table1 --p-over-n 0",
            "backcast bench table1 --noise 26",
            "backcast bench table2 --headings 361",
            "backcast simulate --map m.yaml --path 0,0 --out r.mcap",
            "backcast simulate --map m.yaml --path 0,0,1,1 --out r.mcap --beams 1",
        ]);
    }

    fn check_refused(lines: &[&str]) {
        for line in lines {
            let error = parse(line).expect_err(line);
            assert_eq!(error.exit_code(), 2, "{line}");
        }
    }
}
