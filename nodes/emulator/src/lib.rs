//! Node `emulator`: a SICK laser scanner that sees what a recording saw.
//!
//! `sweep` holds the recorded scans, `player` says when each is due,
//! `cola_device` and `lms2xx_device` answer as the devices do and write their
//! telegrams, `faults` damages them on demand; all pure. `run` serves a socket or
//! a pseudo-terminal. Remissions, polling over CoLa and partial scans are not
//! played: the devices that are emulated refuse or leave them out.

mod cola_device;
mod config;
mod error;
mod faults;
mod lms2xx_device;
mod player;
mod run;
mod sweep;

pub use config::{Config, Rate};
pub use error::EmulatorError;
pub use faults::FaultPlan;
pub use run::run;
