//! `backcast regress`: replays recordings through the graph and compares every
//! answer with what is expected.
//!
//! `case` finds the recordings, `play` runs the graph, `answer` is what is
//! compared, `compare` compares (pure), `junit` reports to a build server.

mod answer;
mod case;
mod command;
mod compare;
mod error;
mod junit;
mod play;

pub use command::{Config, NOTES, run};
pub use error::RegressionError;
