//! What is reported of one method in one case.

use schemars::JsonSchema;
use serde::Serialize;

use super::method::Method;

/// One line of JSON, and one of the table.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub(super) struct Row {
    pub(super) table: String,
    pub(super) method: &'static str,
    pub(super) kind: String,
    /// Cells a side of the square world, 0.05 m each.
    pub(super) size: u32,
    pub(super) beams: u32,
    /// Headings that were searched; 1 where it is known.
    pub(super) headings: usize,
    /// Boundary cells over free cells, as generated.
    pub(super) p_over_n: f64,
    pub(super) noise_percent: f64,
    pub(super) taper: String,
    /// Cells that a reading's votes reach along an axis, on average.
    pub(super) k: f64,
    /// Median for one scan, on one thread; none where it was skipped.
    pub(super) cpu_ms: Option<f64>,
    /// Against the fastest way of reverse projection in the case.
    pub(super) ratio_to_reverse_projection: Option<f64>,
    /// Scans that were measured.
    pub(super) scans: usize,
    /// Share of them that were located to 0.5 m and 10 degrees.
    pub(super) found: Option<f64>,
    /// Headings that were measured, where the time is scaled up from them.
    pub(super) scaled_from_headings: Option<usize>,
    /// As the paper counts them.
    pub(super) operations: Option<f64>,
    /// As the paper counts them.
    pub(super) additions: Option<f64>,
    /// To prepare the map for the method.
    pub(super) prepare_cpu_ms: f64,
    /// What of the prepared map is kept.
    pub(super) map_bytes: usize,
    pub(super) instruction_set: String,
    /// Why the method was left out.
    pub(super) skipped: Option<String>,
    /// As the table names the method.
    #[serde(skip)]
    pub(super) label: &'static str,
}

impl Row {
    pub(super) fn of(&self, method: Method) -> Self {
        let (method, label) = method.names();
        Row {
            method,
            label,
            ..self.clone()
        }
    }

    pub(super) fn without(self, reason: String) -> Self {
        Row {
            skipped: Some(reason),
            ..self
        }
    }
}
