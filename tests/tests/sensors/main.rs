//! From lasers and from other people's recordings into the graph.

mod doctor;
mod lasers;
mod moving_lasers;
mod probe;
mod readers;
