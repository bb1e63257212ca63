//! `backcast convert`: laser logs of CARMEN and bags in SQLite to recordings.
//!
//! `carmen` and `read` parse the text format, `parameters` and `angles` find the geometry of
//! each laser, `turning` the direction of its beams (all pure); `file` detects logs,
//! `lasers` chooses the lines of each laser, `to_recording` translates them; `report` is the summary.

mod angles;
mod carmen;
mod command;
mod file;
mod lasers;
mod parameters;
mod read;
mod report;
mod to_recording;
mod turning;

pub use command::{Config, NOTES, run};
