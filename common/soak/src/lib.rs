//! `backcast soak`: runs a graph for hours, injects random faults, and reports whether it met its
//! guarantees.
//!
//! `fault` defines the faults and draws the next one, `tally` counts the poses and the effect of
//! each fault, `report` formats the results: these are pure. `launched` is the launcher as a child
//! process, `usage` measures its processes, `maps` and `filler` implement two of the faults,
//! `course` runs everything.

mod command;
mod course;
mod fault;
mod filler;
mod launched;
mod maps;
mod recorded;
mod report;
mod tally;
mod usage;

pub use command::{Config, NOTES, run};

/// Schemas of what the command prints.
#[must_use]
pub fn schemas() -> Vec<json::schema::Named> {
    vec![json::schema::of_object::<report::Report>("soak")]
}
