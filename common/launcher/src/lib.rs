//! Starts and controls a graph for its user: `run` builds, starts and supervises the processes,
//! `check` reports errors in the descriptor, and `control` talks to a running launcher. This crate
//! localizes nothing and links none of the nodes.

pub mod check;
pub mod control;
pub mod descriptor;
mod installed;
pub mod run;

pub use installed::node;
