//! Tests of the accumulator as a process.

mod known_heading;
mod node;
mod sets;
mod world;
