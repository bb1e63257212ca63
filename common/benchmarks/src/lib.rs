//! Generated worlds, simulated scans and the paper's other methods of global localization, to
//! compare the engine with.
//!
//! Everything is seeded: the same numbers give the same world, scan and result.

pub mod baselines;
pub mod counted;
mod distinct;
pub mod particles;
pub mod scans;
pub mod scatter;
pub mod timing;
pub mod worlds;

pub use distinct::distinct;

/// Side of a cell of every generated world, in metres.
pub const RESOLUTION_M: f64 = 0.05;
