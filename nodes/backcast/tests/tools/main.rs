//! Tests of the tools as processes: their output, files and errors. They share one executable,
//! because each would link the engine and all formats of recordings.

#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

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
