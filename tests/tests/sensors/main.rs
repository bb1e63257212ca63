//! Lasers and third-party recordings, up to the graph.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod doctor;
mod lasers;
mod moving_lasers;
mod probe;
mod readers;
