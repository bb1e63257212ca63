//! `backcast doctor`: finds the faults of a recording.
//!
//! `finding` is the type of a result. `survey` gathers data in one pass over the messages, and
//! `checks` judges it. `drive` matches scans without a map, and `sensors` compares the result with
//! the odometry. `located` locates scans on the map, and `map_fit` and `delay` compare the result
//! with the map and the odometry. `bands` compares bands of heights of a point cloud. Nothing is
//! repaired.

mod bands;
mod checks;
mod command;
mod delay;
mod drive;
mod finding;
mod located;
mod map_fit;
mod sensors;
mod survey;
#[cfg(test)]
mod tests;

pub(crate) use command::Report;
pub use command::{Config, NOTES, run, run_on};
