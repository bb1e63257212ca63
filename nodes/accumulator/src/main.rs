//! Entry point of the node; see the library.

use std::process::ExitCode;

use accumulator::Config;

fn main() -> ExitCode {
    let config = Config::from_command_line();
    transport::node::main("accumulator", |graph| accumulator::run(graph, &config))
}
