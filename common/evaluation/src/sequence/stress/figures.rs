//! The figures of one variant of a drive.

use serde::Serialize;

use super::super::follow::Followed;
use super::super::run::Tally;
use super::super::starts::Starts;

/// Shares are 0..=1; docs/tracking.md explains each.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Figures {
    pub(super) bag: String,
    pub(super) variant: &'static str,
    pub(super) starts: u64,
    pub(super) wrong_starts: u64,
    /// Scans whose truth is known, after all starts and while followed.
    pub(super) scans: u64,
    pub(super) unique_scans: u64,
    pub(super) wrong_scans: u64,
    pub(super) losses: u64,
    pub(super) right: After,
    pub(super) rms_m: Option<f64>,
}

/// Shares of the starts after this many metres.
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
        starts: &Starts,
        followed: &Followed,
    ) -> Self {
        let Tally {
            scans,
            unique,
            wrong,
        } = starts.tally.with(followed.tally);
        let after = |i: usize| {
            let (right, judged) = (starts.right[i], starts.judged[i]);
            (judged > 0).then(|| right as f64 / judged as f64)
        };
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
        }
    }

    /// As a line of JSON.
    pub(super) fn json(&self) -> String {
        json::object(self)
    }

    /// The names of the columns.
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

    /// As a row of a table.
    pub(super) fn row(&self) -> String {
        let percent = |share: Option<f64>| {
            share.map_or("–".into(), |share| format!("{:.1}", 100.0 * share))
        };
        let rms = self.rms_m.map_or("–".into(), |m| format!("{m:.3}"));
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
            rms,
        )
    }
}
