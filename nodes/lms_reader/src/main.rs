//! Entry point of the node; see the library.

use std::process::ExitCode;

use lms_reader::Config;

fn main() -> ExitCode {
    let config = Config::from_command_line();
    transport::node::main("lms_reader", |graph| lms_reader::run(graph, &config))
}
