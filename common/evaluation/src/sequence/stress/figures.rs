//! Figures of one variant of a drive.

use schemars::JsonSchema;
use serde::Serialize;

use super::super::follow::Followed;
use super::super::run::Tally;
use super::super::starts::{After, Starts};
use crate::text::{number, percent};
use crate::trust::Said;

/// Figures of one variant. Shares are 0..=1; docs/tracking.md explains each.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Figures {
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

impl Figures {
    pub(super) fn new(
        (bag, variant): (String, &'static str),
        (starts, followed): (&Starts, &Followed),
        tally: Tally,
    ) -> Self {
        let mut right = After::of(&starts.right, &starts.judged);
        right.0.retain(|(metres, _)| [5.0, 10.0].contains(metres));
        Figures {
            bag,
            variant,
            starts: starts.starts,
            wrong_starts: starts.wrong.len() as u64,
            scans: tally.scans,
            unique_scans: tally.unique,
            wrong_scans: tally.wrong,
            losses: followed.losses.len() as u64,
            right,
            rms_m: followed.rms_m(),
            probabilities: tally.trust.said().to_vec(),
        }
    }

    pub(super) const HEADER: &str = "  variant                starts  wrong   scans   unique   wrong  losses  5 m, % 10 m, %  RMS, m\n";

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
            percent(self.right.0[0].1),
            percent(self.right.0[1].1),
            number(self.rms_m, 3),
        )
    }
}
