//! Node `replayer`: plays a recording as `scan`, `odometry` and `ground_truth`.
//!
//! `ros_graph::replay` schedules the messages; `run` reads the clock, waits, pauses and sends.
//! Readings are passed on as recorded, even if they are invalid.

mod config;
mod error;
mod run;

pub use config::Config;
pub use error::ReplayerError;
pub use run::run;
