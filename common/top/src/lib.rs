//! `backcast top`: a running graph in the terminal, by the API of its monitor.
//!
//! `known` reads what the monitor sends, `lines` puts it into words, both pure;
//! `source` asks and listens, `screen` shows.

mod command;
mod error;
mod known;
mod lines;
mod screen;
mod source;

pub use command::{Config, run};
pub use error::TopError;
