//! Node `replayer`: plays a recording as `scan`, `odometry` and `ground_truth`.
//!
//! `selection` says what is played of it, `source` and `convert` turn records into
//! messages, `order` sees to it that what belongs to a scan comes before it,
//! `schedule` says when each is due and which answer is waited for, `pause` what
//! is held up, `readiness` who is ready; all pure. `run` reads the clock, waits
//! and sends. Readings are passed on as they were recorded, however odd.

mod config;
mod convert;
mod error;
mod order;
mod pause;
mod rate;
mod readiness;
mod run;
mod schedule;
mod selection;
mod source;

pub use config::Config;
pub use error::ReplayerError;
pub use rate::Rate;
pub use run::{Summary, run};
pub use selection::Remap;
