//! The votes of the poses in blocks of 4 × 4 cells, by exact ranges.
//!
//! They equal those of the plain reference, to the last vote.

pub(crate) mod block_ranges;
pub(crate) mod bundle;
pub(crate) mod leaf;
