//! Figures of one variant of a drive.

use serde::Serialize;

use super::super::follow::Followed;
use super::super::run::Tally;
use super::super::starts::Starts;
use crate::text::{number, percent, share};
use crate::trust::Said;

/// Figures of one variant. Shares are 0..=1; docs/tracking.md explains each.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Figures {
    pub(super) bag: String,
    pub(super) variant: &'static str,
    pub(super) starts: u64,
    pub(super) wrong_starts: u64,
    /// Number of scans with a known truth, after all starts and while followed.
    pub(super) scans: u64,
    pub(super) unique_scans: u64,
    pub(super) wrong_scans: u64,
    pub(super) losses: u64,
    pub(super) right: After,
    pub(super) rms_m: Option<f64>,
    /// Probabilities of the poses, and how many of these were within 1 m and 25°.
    pub(super) probabilities: Vec<Said>,
}

/// Shares of the starts, by metres after the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct After {
    #[serde(rename = "5")]
    pub(super) five: Option<f64>,
    #[serde(rename = "10")]
    pub(super) ten: Option<f64>,
}

impl Figures {
    pub(super) fn new(
        (bag, variant): (String, &'static str),
        (starts, followed): (&Starts, &Followed),
        tally: Tally,
    ) -> Self {
        let Tally {
            scans,
            unique,
            wrong,
            trust,
        } = tally;
        let after = |i: usize| share(starts.right[i], starts.judged[i]);
        Figures {
            bag,
            variant,
            starts: starts.starts,
            wrong_starts: starts.wrong.len() as u64,
            scans,
            unique_scans: unique,
            wrong_scans: wrong,
            losses: followed.losses.len() as u64,
            right: After {
                five: after(2),
                ten: after(3),
            },
            rms_m: followed.rms_m,
            probabilities: trust.said().to_vec(),
        }
    }

    pub(super) fn header() -> String {
        format!(
            "  {:<22}{:>7}{:>7}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}\n",
            "variant",
            "starts",
            "wrong",
            "scans",
            "unique",
            "wrong",
            "losses",
            "5 m, %",
            "10 m, %",
            "RMS, m"
        )
    }

    pub(super) fn row(&self) -> String {
        format!(
            "  {:<22}{:>7}{:>7}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}\n",
            self.variant,
            self.starts,
            self.wrong_starts,
            self.scans,
            self.unique_scans,
            self.wrong_scans,
            self.losses,
            percent(self.right.five),
            percent(self.right.ten),
            number(self.rms_m, 3),
        )
    }
}
