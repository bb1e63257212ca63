//! Recordings without a graph: `locate` finds the place of each scan, `evaluate` judges
//! the places against the truth, and `sequence` follows a drive with the tracker's part
//! of the engine.

mod error;
pub mod evaluate;
pub mod locate;
mod sequence;
mod text;
mod trust;

pub use error::EvaluationError;
