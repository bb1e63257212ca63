//! Node `replayer`: plays a recording as `scan`, `odometry` and `ground_truth`.
//!
//! `replay` schedules the messages; `pause`, which is pure, handles pauses. `run` reads the clock,
//! waits and sends. Readings are passed on as recorded, even if they are invalid.

mod config;
mod error;
mod pause;
mod run;

pub use config::Config;
pub use error::ReplayerError;
pub use run::run;
