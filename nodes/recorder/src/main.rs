//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use recorder::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("recorder", |graph| recorder::run(graph, &config))
}
