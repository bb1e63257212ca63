//! Entry point of the node; see the library.

use std::process::ExitCode;

use locate_server::Config;

fn main() -> ExitCode {
    let config = Config::from_command_line();
    transport::node::main_with_log("locate_server", zenoh_session::LOG, |graph| {
        locate_server::run(graph, &config)
    })
}
