//! Starts the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use ros2_gateway::Config;

fn main() -> ExitCode {
    let words = match ros2_gateway::translated(std::env::args_os()) {
        Ok(words) => words,
        Err(problem) => {
            eprintln!("{}: {problem}", ros2_gateway::NODE);
            return ExitCode::from(2);
        }
    };
    let config = Config::parse_from(words);
    let level = config.log_level.as_deref().unwrap_or("info");
    // Routine log lines of DDS, and attempts to decode a message, are of no interest.
    let log = zenoh_session::LOG.replacen("info", level, 1) + ",rustdds=warn,cdr_encoding=error";
    transport::node::main_with_log(ros2_gateway::NODE, &log, |graph| {
        ros2_gateway::run(graph, &config)
    })
}
