//! Files: what stands at their head, when they are flushed and split, what
//! happens when the disk is full; and the black box.
//!
//! Everything here runs on the thread that writes and knows no graph.

mod black_box;
mod name;
mod parts;
mod preamble;
mod staged;
mod store;
mod tally;

pub(crate) use black_box::{BlackBox, Room};
pub(crate) use parts::{Limits, Parts};
pub(crate) use preamble::Preamble;
pub(crate) use store::Store;
pub(crate) use tally::Tally;
