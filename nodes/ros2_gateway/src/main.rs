//! Starts the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use ros2_gateway::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    // What DDS does in the normal case is of no interest.
    let log = format!("{},rustdds=warn", zenoh_session::LOG);
    transport::node::main_with_log(ros2_gateway::NODE, &log, |graph| {
        ros2_gateway::run(graph, &config)
    })
}
