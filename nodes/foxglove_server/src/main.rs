//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use foxglove_server::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("foxglove_server", |graph| {
        foxglove_server::run(graph, &config)
    })
}
