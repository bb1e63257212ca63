//! `backcast regress`: replays recordings through the graph and compares every result with the
//! expected one.
//!
//! `case` finds the recordings, `play` runs the graph, `answer` is the result of a scan, `compare`
//! compares (pure), `object` is printed for programs, `junit` written for a build server.

mod answer;
mod case;
mod command;
mod compare;
mod junit;
mod object;
mod play;

pub use command::{Config, NOTES, run};

/// Schemas of what the command prints, and of the file of a case.
#[must_use]
pub fn schemas() -> Vec<json::schema::Named> {
    vec![
        json::schema::of_object::<object::Object<'_>>("regress"),
        json::schema::of_file::<case::Expectation>("expected"),
    ]
}
