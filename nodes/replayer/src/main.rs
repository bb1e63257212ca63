//! Entry point of the node; see the library.

use std::process::ExitCode;

use clap::Parser;
use replayer::Config;

/// Exit code if the recording was played but data was lost.
const LOST_DATA: u8 = 3;

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
