//! Tools for recordings: `info` lists what one holds, `doctor` says what is wrong with
//! it, `convert` makes one of other logs and bags, and `simulate` one of a drive that no
//! robot drove.

pub mod convert;
pub mod doctor;
mod each;
mod error;
pub mod info;
pub mod simulate;

pub use error::RecordingToolsError;
