//! Tools for recordings: `info` lists the contents of a recording, `doctor` finds its faults,
//! `convert` converts other logs and bags, and `simulate` records a simulated drive.

pub mod convert;
pub mod doctor;
mod each;
pub mod info;
pub mod simulate;
