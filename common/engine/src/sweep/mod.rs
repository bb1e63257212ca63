//! Line sweeps: the ranges of all cells along one direction, a row at a time.
//!
//! Along a line of a bundle the range of a cell follows from the next one's: 0 if the cell
//! is occupied, else one step more. All cells at one position of the major axis form a row,
//! and the next row is shifted by the same amount for all of them, so a whole row of ranges
//! follows from the row before at once.

mod bits;
mod field;
mod kernel;
mod line;
mod merge;
mod plan;
mod wide;

pub use field::{FieldSweep, Sweep, Workspace};
