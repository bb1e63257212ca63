//! Output for a scan, as a row of a table or as JSON: `line` is the answer to the scan alone,
//! `pose_line` the tracker's pose with it, and `rows` joins both in either order. All pure.

mod frame;
mod line;
mod pose_line;
mod rows;
pub mod testing;

pub use frame::Frame;
pub use line::{Line, number};
pub use pose_line::{PoseLine, Row};
pub use rows::Rows;
