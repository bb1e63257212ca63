//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use emulator::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    transport::node::main("emulator", |graph| emulator::run(graph, &config))
}
