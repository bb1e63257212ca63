//! The search over x, y and all headings, exact by bounds.
//!
//! Blocks of 16 × 16 cells are bounded by their sets of visible ranges, for all headings at
//! once. Those that may still matter are split into blocks of 8 × 8 cells with sets of
//! their own, then into 4 × 4 with intervals of ranges, and at last the poses of those are
//! counted one by one. When no remaining block can reach the floor, every pose at or above
//! it was counted.
//!
//! ```text
//! map ─ bins ─ intervals ─ sets                         prepared once (index)
//!                  │         │
//! scan program ────┼─────────┴─ set bounds ─ 16 × 16, 8 × 8 ─┐
//!                  ├─ interval bounds ────── 4 × 4 ──────────┼─ descent ─ votes
//!                  └─ block_ranges ─ leaf ─────── poses ──────────┘
//! ```
//!
//! Alternatives below the floor come from the blocks with the highest bounds. Where bounds do
//! not distinguish blocks, every pose is counted instead (`counting`).
//!
//! Each folder imports only those before it: `index`, the prepared map; `bounds`, upper
//! bounds of the votes in a block; `leaves`, the votes of poses; `task`, the data that
//! threads share; `counting`, counting every pose; `plan`, the order of a search.

mod bounds;
mod counting;
mod index;
mod leaves;
mod plan;
mod task;

pub use index::{IndexKey, SECTIONS, SearchIndex, SectionError, UncheckedIndex};
pub(crate) use plan::Attempt;
pub use plan::{BlockBounds, Workspace};
pub(crate) use task::lead::Lead;
