//! `backcast convert`: laser logs of CARMEN to recordings and back.
//!
//! `carmen`, `read` and `write` are the text format, `parameters` and `angles` what a log says
//! of its lasers beside their readings, `turning` which way their beams run (all pure);
//! `file` detects kinds of files, `survey` reads a log for the first time, `to_recording`
//! and `to_carmen` translate. Lines that are not converted are counted by kind (`tally`);
//! `report` says what came of it.

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
mod to_carmen;
mod to_recording;
mod turning;
mod write;

pub use command::{Config, NOTES, run};
