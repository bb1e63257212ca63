//! What the engine is measured with: generated worlds, simulated scans, and
//! the other methods of global localization that the paper compares with.
//!
//! Everything is seeded: the same numbers give the same world, scan and answer.

pub mod baselines;
pub mod counted;
mod error;
pub mod particles;
pub mod scans;
pub mod timing;
pub mod worlds;

pub use error::BenchmarksError;

/// Side of a cell of every generated world, metres.
pub const RESOLUTION_M: f64 = 0.05;
