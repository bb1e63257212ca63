//! Entry point of the command `backcast`; see the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    backcast::cli::main()
}
