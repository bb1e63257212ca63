//! Tests of the tools as processes, in one executable, as each would link all formats.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bags;
mod convert;
mod docs;
mod drawn;
mod evaluate;
mod init;
mod locate;
mod locate_errors;
mod paper;
mod plot;
mod recording_tools;
mod schemas;
mod simulate;
