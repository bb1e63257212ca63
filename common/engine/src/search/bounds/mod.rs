//! Upper bounds of the votes in blocks, from the ranges that the index says they see.
//!
//! Each bound is admissible: no pose of the block has more votes at that heading, because
//! each beam may choose the best cell of the block for itself. They differ in tightness and
//! cost.

pub(in crate::parts::search) mod group;
pub(in crate::parts::search) mod interval_bounds;
pub(in crate::parts::search) mod interval_program;
pub(in crate::parts::search) mod quad_rows;
pub(in crate::parts::search) mod sectors;
pub(in crate::parts::search) mod set_bounds;
pub(in crate::parts::search) mod set_program;
