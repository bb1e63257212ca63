//! Entry point of the node; see the library.

use std::process::ExitCode;

use map_server::Config;
use transport::node::CHECK_ARGUMENTS_VARIABLE;

fn main() -> ExitCode {
    let config =
        command_line::parse(
            |config: &Config| match std::env::var_os(CHECK_ARGUMENTS_VARIABLE) {
                Some(_) => {
                    map_server::check(config).map_err(|error| transport::with_causes(&error))
                }
                None => Ok(()),
            },
        );
    transport::node::main("map_server", |graph| map_server::run(graph, &config))
}
