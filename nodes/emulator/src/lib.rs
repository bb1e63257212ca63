//! Node `emulator`: a SICK laser scanner that sees what a recording saw.
//!
//! `drive` and `sweep` hold what was recorded, `player` says when each of it is due,
//! `cola_device` and `lms2xx_device` answer as the devices do and write their
//! telegrams, `faults` damages them on demand; all pure. `run` serves a socket or
//! a pseudo-terminal, and publishes odometry and true poses, which no laser sends.
//! Remissions, polling over CoLa and partial scans are not played: the devices
//! that are emulated refuse or leave them out.

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
pub use run::{Summary, run};
