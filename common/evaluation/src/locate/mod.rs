//! `backcast locate`: finds the pose of each scan of a recording. One process and no graph; a line
//! for each scan, in the format of `backcast run`, or JSON.
//!
//! It does not compare with a truth, and keeps no state from scan to scan.

mod command;
mod object;
mod particles;

pub use command::{Config, run};
pub(crate) use object::Object;
