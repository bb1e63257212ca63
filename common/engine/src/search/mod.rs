//! The search over x, y and all headings, exact by bounds.
//!
//! Blocks of 16 × 16 cells are bounded by their sets of visible ranges, for all
//! headings at once. What may still matter is split into blocks of 8 × 8 cells
//! with sets of their own, then into 4 × 4 with intervals of ranges, and last
//! the poses of those are counted one by one. When no block that is left can
//! reach the floor, every pose above it has been seen.
//!
//! ```text
//! map ─ bins ─ intervals ─ sets                         prepared once (index)
//!                  │         │
//! scan program ────┼─────────┴─ set bounds ─ 16 × 16, 8 × 8 ─┐
//!                  ├─ interval bounds ────── 4 × 4 ──────────┼─ descent ─ votes
//!                  └─ outlook ─ leaf ─────── poses ──────────┘
//! ```
//!
//! Alternatives below the floor come from the most promising blocks. Where bounds do
//! not tell blocks apart, every pose is counted instead (`sift.rs`): `attempt.rs` is one
//! search, whichever way it goes.

mod alternatives;
mod attempt;
mod bins;
mod bits;
mod block_bounds;
mod block_ids;
mod budget;
mod bundle;
mod cell_lanes;
mod descent;
mod group;
mod heading_bounds;
mod heading_lanes;
mod index;
mod interval_bounds;
mod interval_program;
mod intervals;
mod lanes;
mod leaf;
mod needed;
mod obstacles;
mod outlook;
mod parts;
mod prefetch;
mod quad_rows;
mod queue;
mod ray_lanes;
mod sectors;
mod set_bounds;
mod set_program;
mod sets;
mod sift;
mod steps;
mod task;
mod within;
mod words;

pub use block_bounds::BlockBounds;
pub use index::{SearchIndex, Workspace};
