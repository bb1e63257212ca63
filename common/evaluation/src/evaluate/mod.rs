//! `backcast evaluate`: how often and how well the place is found, against the
//! true poses of recordings. A row or a JSON object for each file, and how
//! far the probabilities of the answers can be believed.
//!
//! One process and no graph. Scans without a true pose are not searched, and a
//! file that is damaged or holds no truth is an error and no figure.

mod command;
mod judge;
mod limits;
mod memory;
mod table;

pub use command::{Config, NOTES, run};
