//! `backcast top`: shows a running graph in the terminal, with the API of its monitor.

mod command;
mod known;
mod lines;
mod screen;
mod source;

pub(crate) use command::{Config, run};
