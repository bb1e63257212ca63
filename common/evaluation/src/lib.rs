//! Evaluation of recordings without a graph: `locate` finds the pose of each scan, `evaluate`
//! compares the poses with the ground truth, and `sequence` runs the tracker over a drive.

pub mod evaluate;
pub mod locate;
mod outcomes;
mod sequence;
mod text;
mod trust;
mod truths;
