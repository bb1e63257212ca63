//! The order in which a map is searched: from large blocks down to poses, the highest bound
//! first.
//!
//! When a search ends, every pose at or above its floor was counted: a block is dropped
//! only if its bound is lower. If bounds do not distinguish blocks, all poses are counted
//! instead. Candidates below the floor come from the blocks with the highest bounds.

mod alternatives;
mod attempt;
mod block_bounds;
mod descent;
mod parts;
mod search;

pub(crate) use attempt::Attempt;
pub use block_bounds::BlockBounds;
pub use search::Workspace;
