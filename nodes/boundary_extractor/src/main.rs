//! Starts the node; see the library.

use std::process::ExitCode;

use boundary_extractor::Config;
use clap::Parser;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("boundary_extractor", |graph| {
        boundary_extractor::run(graph, &config)
    })
}
