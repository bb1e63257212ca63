//! The votes of the poses in blocks of 4 × 4 cells, by exact ranges.
//!
//! They equal those of the plain reference, to the last vote.

pub(in crate::parts::search) mod block_ranges;
pub(in crate::parts::search) mod bundle;
pub(in crate::parts::search) mod leaf;
