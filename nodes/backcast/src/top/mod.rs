//! `backcast top`: shows a running graph in the terminal, with the API of its monitor.
//!
//! `known` parses the monitor's messages, `lines` formats them, both pure; `source` connects to the
//! monitor, `screen` draws.

mod command;
mod known;
mod lines;
mod screen;
mod source;

pub(crate) use command::{Config, run};
