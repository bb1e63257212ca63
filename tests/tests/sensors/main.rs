//! Lasers and third-party recordings, up to the graph.

mod doctor;
mod lasers;
mod moving_lasers;
mod probe;
mod readers;
