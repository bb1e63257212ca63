//! `backcast top`: shows a running graph.

use std::io::{IsTerminal, stdout};
use std::process::ExitCode;
use std::time::Instant;

use command_line::stdout as output;

use super::{lines, screen, source};

#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// Address of the monitor
    #[arg(default_value = "127.0.0.1:7440", value_name = "HOST:PORT")]
    address: String,

    /// Name of the robot [default: the first that the monitor knows]
    #[arg(long, value_name = "NAME")]
    robot: Option<String>,

    /// Print the current state once, and exit; this is also done if the output is not a terminal
    #[arg(long)]
    once: bool,
}

pub(crate) fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let robot = source::find(&config.address, config.robot.as_deref())?;
    let known = source::snapshot(&config.address, &robot)?;
    if config.once || !stdout().is_terminal() {
        output::print(&lines::plain(&known, Instant::now()))?;
    } else {
        screen::show(known, &source::follow(&config.address, &robot)?)?;
    }
    Ok(ExitCode::SUCCESS)
}
