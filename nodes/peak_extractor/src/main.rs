//! Entry point of the node; see the library.

use std::process::ExitCode;

use peak_extractor::Config;

fn main() -> ExitCode {
    let config = Config::from_command_line();
    transport::node::main("peak_extractor", |graph| {
        peak_extractor::run(graph, &config)
    })
}
