//! Node `tracker`: keeps the robot's pose over time, from `scan`, `odometry`, `map` and
//! `hypotheses` to `pose`; asks for searches on `attention`.
//!
//! Which place is believed is the engine's to decide (`engine::tracking`). Here, `world`
//! knows the map, `queue` keeps what waits, `message` says what is sent, and `memory`
//! keeps the last pose on disk. Only `run` touches the graph and the clock.
//!
//! Each scan is answered by exactly one pose, in the order of the scans. Where a scan
//! needs a search, it waits for its hypotheses, and later scans wait behind it: so the
//! same scans, odometry and hypotheses give the same poses, however fast they come.

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
