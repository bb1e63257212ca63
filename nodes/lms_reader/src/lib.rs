//! Node `lms_reader`: scans from a SICK laser scanner, published as `scan`.
//!
//! `sick` turns bytes into telegrams; `scan` and `lms2xx_scan` turn telegrams into
//! messages; `cola_setup` and `lms2xx_setup` say what is asked of a device before
//! scans come; `angles` say which way it looks; `clock` brings the device's time to the
//! host's; all pure. `run` reads from the device or a capture and sends. A device is
//! started to send scans; its settings stay as they are unless the configuration asks for
//! others.

mod angles;
mod attempts;
mod backoff;
mod clock;
mod cola_setup;
mod config;
mod error;
mod error_limit;
mod lms2xx_scan;
mod lms2xx_setup;
mod pace;
mod run;
pub mod scan;

pub use config::{Config, Rate, Reach};
pub use error::LmsError;
pub use run::run;
