//! Files of a recording: their head, flushing, splitting, and handling of a full disk; and the
//! black box.
//!
//! Everything here runs on the writer thread and does not use the graph.

mod black_box;
mod name;
mod parts;
mod preamble;
mod staged;
mod store;
#[cfg(test)]
mod testing;

pub(crate) use black_box::{BlackBox, Room};
pub(crate) use parts::{Limits, Parts};
pub(crate) use preamble::Preamble;
pub(crate) use store::{Store, Tally};
