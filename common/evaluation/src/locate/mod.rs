//! `backcast locate`: where was each scan of a recording taken? One process and
//! no graph; a line for each scan, as `backcast run` prints it, or JSON.
//!
//! It compares with no truth, and remembers nothing from scan to scan.

mod command;
mod object;
mod particles;
mod row;

pub use command::{Config, run};
