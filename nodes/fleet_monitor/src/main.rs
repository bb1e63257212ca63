//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use fleet_monitor::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main_with_log("fleet_monitor", zenoh_session::LOG, |graph| {
        fleet_monitor::run(graph, &config)
    })
}
