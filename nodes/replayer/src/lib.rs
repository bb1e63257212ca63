//! Node `replayer`: plays a recording as `scan`, `odometry` and `ground_truth`.
//!
//! `replay` says which message is due when; `pause`, which is pure, what is held
//! up. `run` reads the clock, waits and sends. Readings are passed on as they were
//! recorded, however odd.

mod config;
mod error;
mod pause;
mod run;

pub use config::Config;
pub use error::ReplayerError;
pub use run::{Summary, run};
