//! Tests of the accumulator as a process.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod known_heading;
mod node;
mod sets;
mod world;
