//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use monitor::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("monitor", |graph| monitor::run(graph, &config))
}
