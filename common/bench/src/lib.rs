//! `backcast bench`: the paper's tables and the search, every method on the
//! same generated worlds with the same scans, in one run and on one thread; in
//! `paper`, all claims of the paper; and in `docs`, the figures of the documents.
//!
//! `worlds` and `scans` are generated from seeds: the same numbers give the same world, scan and
//! result. `baselines` and `scatter` are the methods that the engine is compared with.

pub mod baselines;
mod command;
mod contest;
pub mod counted;
mod distinct;
mod docs;
mod engine_methods;
mod line_up;
mod measure;
mod method;
mod paper;
mod row;
pub mod scans;
pub mod scatter;
mod scope;
mod text;
pub mod timing;
pub mod worlds;

pub use command::{Config, NOTES, run};
pub use distinct::distinct;

/// Side of a cell of every generated world, in metres.
pub const RESOLUTION_M: f64 = 0.05;

pub fn schemas() -> Vec<command_line::json::schema::Named> {
    vec![command_line::json::schema::of_object::<row::Row>("bench")]
}
