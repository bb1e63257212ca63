//! Node `tracker`: tracks the robot's pose over time, from `scan`, `odometry`, `map` and
//! `hypotheses` to `pose`; requests searches on `attention`.
//!
//! The engine decides which place is believed (`engine::tracking`). Here, `world` holds the maps,
//! `queue` the waiting scans and answers, `message` builds the output, and `memory` stores the last
//! pose on disk. Only `run` uses the graph and the clock.
//!
//! Each scan is answered by exactly one pose, in the order of the scans. If a scan needs a search,
//! it waits for its hypotheses, and later scans wait behind it, so that the same scans, odometry
//! and hypotheses give the same poses regardless of timing.

mod config;
mod error;
mod memory;
mod message;
mod queue;
mod run;
mod world;

pub use config::Config;
pub use error::TrackerError;
pub use run::run;
