//! The answer to a scan and the tracker's pose, as JSON and as rows of a table. `place` has what
//! both share, `answer` the answer to a scan alone, `tracked` the tracker's pose, and `rows` joins
//! both in either order. All pure.

mod answer;
mod frame;
mod place;
mod rows;
pub mod testing;
mod tracked;

pub use answer::{ScanAnswer, number};
pub use frame::Frame;
pub use place::{Candidate, Place, map_id};
pub use rows::Rows;
pub use tracked::{Row, TrackedPose};
