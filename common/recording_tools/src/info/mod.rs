//! `backcast info`: lists the contents of a recording.
//!
//! `contents` gathers them, `text` and JSON print them. Faults are left to `doctor`.

mod command;
mod contents;
mod text;

pub use command::{Config, run};
pub(crate) use contents::Contents;
