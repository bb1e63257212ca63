//! The command `backcast`: the launcher of a graph and the tools around it.
//!
//! Each command has a `Config` for clap and a function that does the work and returns the exit
//! code, here or in a crate under `common`; in `cli` the commands get their names. Without the
//! feature `tools`, only the launcher is included, for use on a robot.

pub mod cli;
#[cfg(feature = "tools")]
mod init;
#[cfg(feature = "tools")]
mod probe;
#[cfg(feature = "tools")]
mod top;
