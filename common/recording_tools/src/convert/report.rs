//! What came of a conversion.

use super::tally::Tally;

/// What was converted.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Report {
    pub(super) scans: u64,
    pub(super) odometry: u64,
    /// Messages of a bag, whatever they are.
    pub(super) messages: u64,
    /// How lasers were understood, a line each.
    pub(super) remarks: Vec<String>,
    /// Lines of a log that were left out.
    pub(super) tally: Tally,
    /// Why the file could not be read to its end.
    pub(super) damage: Option<String>,
    /// Scans whose laser sits elsewhere than that of the first one.
    pub(super) moved_mounts: u64,
}

impl Report {
    /// What could not be read, a line each.
    pub(super) fn losses(&self) -> Vec<String> {
        let mut losses = Vec::new();
        if let Some(first) = &self.tally.first_broken {
            losses.push(format!(
                "{} could not be read; {first}",
                self.tally.broken_lines()
            ));
        }
        if let Some(damage) = &self.damage {
            losses.push(format!(
                "it is damaged, and was read only to there: {damage}"
            ));
        }
        losses
    }

    /// Why there is nothing, in words.
    pub(super) fn why_nothing(&self) -> String {
        let mut reasons = Vec::new();
        if self.odometry > 0 {
            reasons.push(format!("{} poses of the odometry", self.odometry));
        }
        reasons.extend(self.tally.text());
        reasons.extend(self.losses());
        match reasons.is_empty() {
            true => "it is empty".to_owned(),
            false => format!("it holds {}", reasons.join("; ")),
        }
    }
}
