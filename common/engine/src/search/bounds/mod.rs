//! Upper bounds of the votes in blocks, from the ranges that the index says they see.
//!
//! Each bound is admissible: no pose of the block has more votes at that heading, because
//! each beam may choose the best cell of the block for itself. They differ in tightness and
//! cost.

pub(crate) mod group;
pub(crate) mod interval_bounds;
pub(crate) mod quad_rows;
pub(crate) mod sectors;
pub(crate) mod set_bounds;
pub(crate) mod set_program;
