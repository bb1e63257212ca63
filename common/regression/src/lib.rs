//! `backcast regress`: replays recordings through the graph and compares every result with the
//! expected one.
//!
//! `case` finds the recordings, `play` runs the graph, `answer` is the result of a scan, `compare`
//! compares (pure), `junit` writes a report for a build server.

mod answer;
mod case;
mod command;
mod compare;
mod junit;
mod play;

pub use command::{Config, NOTES, run};
