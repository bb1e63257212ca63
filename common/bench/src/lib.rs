//! `backcast bench`: the paper's tables and the search, every method on the
//! same generated worlds with the same scans, in one run and on one thread; and, in
//! `paper`, all claims of the paper.

mod command;
mod contest;
mod engine_methods;
mod line_up;
mod measure;
mod method;
mod paper;
mod row;
mod scope;
mod text;

pub use command::{Config, NOTES, run};

/// Schemas of what the command prints.
#[must_use]
pub fn schemas() -> Vec<json::schema::Named> {
    vec![json::schema::of_object::<row::Row>("bench")]
}
