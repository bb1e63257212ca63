//! The command `backcast`: the launcher of a graph and the tools around it.
//!
//! One file or folder a command, all with the same verbs: a `Config` that clap
//! reads, and a function that does the work and returns the exit code. Only
//! `cli` knows all of them. The graph's localizer runs in its own processes, and
//! this crate depends on none of theirs; what runs without a graph asks the
//! engine itself, by way of `offline`.

pub mod cli;

mod bench;
mod check;
mod control;
mod convert;
mod descriptor;
mod doctor;
mod error;
mod evaluate;
mod info;
mod locate;
mod offline;
mod plot;
mod probe;
mod regress;
mod run;
mod sequence;
mod simulate;
mod soak;
mod statistics;
mod stdout;
mod top;

pub use error::BackcastError;
