//! Node `lms_reader`: scans from a SICK laser scanner, published as `scan`.
//!
//! `sick` turns bytes into telegrams; `scan` and `lms2xx_scan` turn telegrams into messages;
//! `cola_setup` and `lms2xx_setup` run the dialogue before scans are sent; `angles` decides which
//! way the device looks; `clock` converts device time to host time. `run`
//! reads from the device or a capture and publishes. The node starts the scans of a device but
//! leaves its settings alone unless the configuration asks for others.

mod angles;
mod clock;
mod cola_setup;
mod config;
mod error;
mod lms2xx_scan;
mod lms2xx_setup;
mod pace;
mod run;
pub mod scan;

pub use config::{Config, Rate, Reach};
pub use error::LmsError;
pub use run::run;

/// Number of times that a command is sent before it counts as unanswered.
const TRIES: u32 = 3;
