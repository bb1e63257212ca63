//! Entry point of the node; see the library.

use std::process::ExitCode;

use tracker::Config;

fn main() -> ExitCode {
    let config = Config::from_command_line();
    transport::node::main("tracker", |graph| tracker::run(graph, &config))
}
