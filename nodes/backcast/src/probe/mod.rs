//! `backcast probe`: shows the type, settings and a scan of a laser. No setting of the device is
//! changed; an LMS2xx is left waiting for commands.

mod cola;
mod command;
mod error;
mod line;
mod lms2xx;
mod picture;

pub(crate) use command::{Config, NOTES, default_reader_options, reader_options, run};
