//! Tests of the accumulator as a process.

#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

mod known_heading;
mod node;
mod sets;
mod world;
