//! `backcast evaluate --sequence`: how the tracker does on a drive whose true poses are
//! known. It starts at many scans of the drive, follows the whole of it, is put elsewhere,
//! and sends no data for a while; see docs/tracking.md.

mod command;
mod course;
mod drive;
mod errors;
mod figures;
mod follow;
mod interruption;
mod jumps;
mod limits;
mod names;
mod options;
mod outages;
mod run;
mod starts;
mod stress;

pub(crate) use command::evaluate;
pub(crate) use options::SequenceOptions;
