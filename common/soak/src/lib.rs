//! `backcast soak`: runs a graph for hours, does it harm at random, and returns whether it
//! met its guarantees.
//!
//! `fault` says what can be done and draws what is done next, `tally` counts the poses and
//! how long each fault had an effect, `report` puts both into words: these are pure. `launched`
//! is the launcher as a child process, `usage` what its processes take, `maps` and
//! `filler` what some faults need, `course` does all of it.

mod command;
mod course;
mod error;
mod fault;
mod filler;
mod launched;
mod maps;
mod report;
mod tally;
mod usage;

pub use command::{Config, NOTES, run};
pub use error::SoakError;
