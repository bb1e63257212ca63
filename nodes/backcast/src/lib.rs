//! The command `backcast`: the launcher of a graph and the tools around it.
//!
//! Each command is implemented in a crate under `common`, with a `Config` for clap and a function
//! that does the work and returns the exit code; here the commands get their names. Without the
//! feature `tools`, only the launcher is included, for use on a robot.

pub mod cli;
