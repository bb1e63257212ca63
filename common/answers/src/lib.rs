//! The answer to a scan and the tracker's pose, as JSON and as rows of a table, and how often they
//! are right. `place` has what both share, `answer` the answer to a scan alone, `tracked` the
//! tracker's pose, `rows` joins both in either order, and `statistics` judges them. All pure.

mod answer;
mod place;
mod rows;
pub mod statistics;
pub mod testing;
mod tracked;

pub use answer::{ScanAnswer, number};
pub use place::{Candidate, Frame, Place, map_id};
pub use rows::Rows;
pub use tracked::{Row, TrackedPose};
