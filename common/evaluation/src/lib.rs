//! Evaluation of recordings without a graph: `locate` finds the pose of each scan, `evaluate`
//! compares the poses with the ground truth, and `sequence` runs the tracker over a drive.

mod error;
pub mod evaluate;
pub mod locate;
mod sequence;
mod text;
mod trust;

pub use error::EvaluationError;
