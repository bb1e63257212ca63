//! The reader as a process.

mod angles;
mod node;
