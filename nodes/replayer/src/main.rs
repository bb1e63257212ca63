//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use command_line::LOST_DATA;
use replayer::Config;

fn main() -> ExitCode {
    let config = Config::parse();
    let mut lost_data = false;
    let code = transport::node::main("replayer", |graph| {
        replayer::run(graph, &config).map(|summary| lost_data = summary.lost_data())
    });
    if lost_data {
        return ExitCode::from(LOST_DATA);
    }
    code
}
