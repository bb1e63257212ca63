//! Starts the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use ros2_gateway::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main_with_log(ros2_gateway::NODE, zenoh_session::LOG, |graph| {
        ros2_gateway::run(graph, &config)
    })
}
