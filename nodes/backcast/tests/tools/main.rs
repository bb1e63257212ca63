//! The tools of the command as processes: what they print, write and refuse. In one
//! executable, since each links the engine and all formats of recordings.

mod bags;
mod convert;
mod drawn;
mod evaluate;
mod init;
mod locate;
mod locate_errors;
mod paper;
mod plot;
mod recording_tools;
mod simulate;
