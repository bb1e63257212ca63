//! `backcast probe`: which laser is there, how it is set, and what it sees.
//!
//! `cola` and `lms2xx` ask the device, over a `line`; `picture` draws a scan in
//! characters. No setting is changed but the baud rate that the device has, which
//! is found by trying; an LMS2xx is left waiting for commands.

mod cola;
mod command;
mod error;
mod line;
mod lms2xx;
mod picture;

pub use command::{Config, NOTES, default_reader_options, reader_options, run};
pub use error::ProbeError;
