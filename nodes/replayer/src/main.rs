//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use replayer::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("replayer", |graph| replayer::run(graph, &config))
}
