//! Entry point of the node; see the library.

use std::process::ExitCode;

use bridge::Config;
use clap::Parser;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main_with_log("bridge", zenoh_session::LOG, |graph| {
        bridge::run(graph, &config)
    })
}
