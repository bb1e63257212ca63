//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use map_server::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("map_server", |graph| map_server::run(graph, &config))
}
