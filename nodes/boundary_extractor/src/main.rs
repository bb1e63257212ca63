//! Entry point of the node; see the library.

use std::process::ExitCode;

use boundary_extractor::Config;
use clap::Parser;

fn main() -> ExitCode {
    let Config {} = Config::parse();
    transport::node::main("boundary_extractor", boundary_extractor::run)
}
