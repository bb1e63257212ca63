//! `backcast regress`: replays recordings through the graph and compares every result with the
//! expected one.
//!
//! `case` finds the recordings, `play` runs the graph, `answer` is the result of a scan, `compare`
//! compares (pure), `outcome` is printed for programs and written for a build server.

mod answer;
mod case;
mod command;
mod compare;
mod outcome;
mod play;

pub(crate) use case::Expectation;
pub use command::{Config, NOTES, run};
pub(crate) use outcome::Object;
