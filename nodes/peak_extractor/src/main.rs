//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use peak_extractor::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("peak_extractor", |graph| {
        peak_extractor::run(graph, &config)
    })
}
