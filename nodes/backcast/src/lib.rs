//! The command `backcast`: the launcher of a graph and the tools around it, each with a `Config`
//! for clap and a function that does the work, here or in a crate under `common`.

pub mod cli;
#[cfg(feature = "tools")]
mod init;
#[cfg(feature = "tools")]
mod probe;
#[cfg(feature = "tools")]
mod top;
