//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use tracker::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("tracker", |graph| tracker::run(graph, &config))
}
