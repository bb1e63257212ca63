//! `backcast convert`: laser logs of CARMEN and bags in SQLite to recordings.
//!
//! `carmen` and `read` parse the text format, `parameters` and `angles` find the geometry of
//! each laser, `turning` the direction of its beams (all pure); `file` detects kinds of files,
//! `survey` reads a log for the first time, `to_recording` translates it. Lines that are not
//! converted are counted by kind (`tally`); `report` is the summary.

mod angles;
mod carmen;
mod command;
mod file;
mod parameters;
mod read;
mod report;
mod source;
mod survey;
mod tally;
mod to_recording;
mod turning;

pub use command::{Config, NOTES, run};
