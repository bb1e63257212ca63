//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use command_line::LOST_DATA;
use recorder::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    let mut lost_data = false;
    let code = transport::node::main("recorder", |graph| {
        recorder::run(graph, &config).map(|summary| lost_data = summary.lost_data())
    });
    if lost_data {
        return ExitCode::from(LOST_DATA);
    }
    code
}
