//! `backcast evaluate --sequence`: evaluates the tracker on a drive with known true poses. It
//! starts the tracker at many scans, follows the whole drive, and simulates kidnapping and outages;
//! see docs/tracking.md.

mod command;
mod course;
mod drive;
mod errors;
mod figures;
mod follow;
mod interruption;
mod limits;
mod options;
mod run;
mod starts;
mod stress;

pub(crate) use command::evaluate;
pub(crate) use errors::{Errors, Samples};
pub(crate) use figures::Figures;
pub(crate) use limits::above_zero;
pub(crate) use options::{SequenceOptions, Task};
pub(crate) use run::WRONG;
pub(crate) use stress::Figures as StressFigures;
