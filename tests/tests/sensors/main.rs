//! From lasers and from other people's recordings into the graph.

mod lasers;
mod moving_lasers;
mod probe;
mod readers;
