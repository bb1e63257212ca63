//! Lasers and third-party recordings, up to the graph.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod doctor;
mod lasers;
mod moving_lasers;
mod probe;
mod readers;
