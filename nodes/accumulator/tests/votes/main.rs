//! The accumulator as a process.

mod known_heading;
mod node;
mod sets;
mod world;
