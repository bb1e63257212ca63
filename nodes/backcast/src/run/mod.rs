//! `backcast run`: builds the graph's nodes, starts and supervises their
//! processes, and prints a pose for each scan.
//!
//! Joined to the graph, it only listens: it localizes nothing, and the graph
//! runs without it. What is decided (restarts, the end of the run, figures and
//! lines) is decided in pure files; `launch` does the work.

mod added;
pub(crate) mod arguments;
pub(crate) mod build;
pub(crate) mod console;
pub(crate) mod control;
pub(crate) mod crew;
mod forward;
mod foxglove;
mod journal;
mod lasers;
mod launch;
mod line;
mod log_files;
mod options;
mod output;
mod pairs;
mod pose_line;
mod process;
mod record;
pub(crate) mod replay;
mod report;
mod rows;
mod summary;
pub(crate) mod supervision;
pub(crate) mod tracker;
mod tracking;
mod watch;

pub(crate) use launch::run;
pub(crate) use line::Line;
pub(crate) use options::{Config, Options};
