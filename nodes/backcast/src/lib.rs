//! The command `backcast`: the launcher of a graph and the tools around it.
//!
//! One file or folder a command, all with the same verbs: a `Config` that clap
//! reads, and a function that does the work and returns the exit code. Only
//! `cli` knows all of them. A localizer is not in here: it runs in its own
//! processes, and this crate depends on none of theirs.

pub mod cli;

mod check;
mod descriptor;
mod error;
mod run;
mod statistics;
mod stdout;

pub use error::BackcastError;
