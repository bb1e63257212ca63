//! `backcast probe`: shows the type, settings and a scan of a laser.
//!
//! `cola` and `lms2xx` ask the device, over a `line`; `picture` draws a scan with characters. No
//! setting of the device is changed; its baud rate is found by trying. An LMS2xx is left waiting
//! for commands.

mod cola;
mod command;
mod error;
mod line;
mod lms2xx;
mod picture;

pub(crate) use command::{Config, NOTES, default_reader_options, reader_options, run};
