//! `backcast simulate`: records a simulated drive through a map, with the ground truth.
//!
//! The crate `simulation` generates the true poses and the sensor data; this module converts them
//! to messages and a file. It searches nothing.

mod command;
mod lidar;
mod messages;

pub use command::{Config, run};
