//! Node `lms_reader`: scans from a SICK laser scanner, published as `scan`.
//!
//! `cola_b` turns bytes into telegrams and `scan` telegrams into messages, both
//! pure; `run` reads from the device or a capture and sends. It speaks CoLa B
//! and asks the device for nothing but to send scans: it neither logs in nor
//! changes parameters.

mod backoff;
pub mod cola_b;
mod complaints;
mod config;
mod error;
mod pace;
mod run;
pub mod scan;

pub use config::{Config, Rate};
pub use error::LmsError;
pub use run::run;
