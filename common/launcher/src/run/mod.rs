//! `backcast run`: builds the graph's nodes, starts and supervises their processes, and prints a
//! pose for each scan. Decisions are in pure files; `launch` does the I/O.

mod added;
pub mod arguments;
pub mod build;
pub mod console;
pub mod control;
pub mod crew;
mod forward;
mod foxglove;
mod journal;
pub(crate) mod lasers;
mod launch;
mod log_files;
mod options;
mod output;
mod pairs;
mod process;
mod record;
mod recording;
pub mod replay;
mod report;
pub(crate) mod shared;
mod summary;
pub mod supervision;
#[cfg(test)]
pub(crate) mod testing;
pub mod tracker;
mod tracking;
mod watch;

pub(crate) use journal::SummaryLine;
pub use launch::run;
pub use options::{Config, Options};
pub(crate) use process::{executable, not_started};
