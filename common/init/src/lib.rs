//! `backcast init`: a commented descriptor for a laser, a ROS 2 robot or a recording, and
//! its map. What it names is looked at before: the laser is asked how it speaks, the map is
//! read. It starts nothing.

mod command;
mod descriptor;
mod error;

pub use command::{Config, NOTES, run};
pub use error::InitError;
