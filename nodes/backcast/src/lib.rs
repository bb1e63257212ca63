//! The command `backcast`: the launcher of a graph and the tools around it.
//!
//! Each command lies in a crate under `common`, with a `Config` that clap reads and a
//! function that does the work and returns the exit code; here they get their names.
//! Without the feature `tools` there is the launcher alone, as a robot needs it.

pub mod cli;
