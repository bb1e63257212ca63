//! The command `backcast`; all that it does is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    backcast::cli::main()
}
