//! The drives to be evaluated, and how.

use std::path::PathBuf;

use map::OccupancyGrid;
use offline::Options;

use super::SequenceOptions;
use crate::outcomes::ReportOptions;
use crate::truths::TruthOptions;

/// Drives and options of `backcast evaluate --sequence`.
pub(crate) struct Task<'a> {
    pub(crate) bags: &'a [PathBuf],
    /// The map, unless it is that of each recording.
    pub(crate) map: Option<&'a OccupancyGrid>,
    pub(crate) options: &'a Options,
    pub(crate) sequence: &'a SequenceOptions,
    pub(crate) truths: &'a TruthOptions,
    pub(crate) report: &'a ReportOptions,
}
