//! Node `emulator`: emulates a SICK laser scanner from a recording.
//!
//! `drive` and `sweep` hold the recording, `player` schedules it, `cola_device` and `lms2xx_device`
//! answer commands and write telegrams like the real devices, `faults` damages telegrams on demand;
//! all are pure. `run` serves a socket or a pseudo-terminal, and publishes odometry and ground
//! truth, which no laser sends. Remissions, polling over CoLa and partial scans are not supported:
//! the emulated devices reject or omit them.

mod cola_device;
mod config;
mod drive;
mod error;
mod faults;
mod lms2xx_device;
mod player;
mod run;
mod sweep;

pub use config::Config;
pub use error::EmulatorError;
pub use faults::FaultPlan;
pub use run::run;
