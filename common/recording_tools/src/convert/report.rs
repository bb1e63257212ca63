use super::tally::Tally;

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Report {
    pub(super) scans: u64,
    pub(super) odometry: u64,
    /// Number of messages of a bag, of any type.
    pub(super) messages: u64,
    /// Descriptions of the lasers, one line each.
    pub(super) remarks: Vec<String>,
    pub(super) tally: Tally,
    pub(super) damage: Option<String>,
    /// Number of scans with another mount than the first one of their laser.
    pub(super) moved_mounts: u64,
}

impl Report {
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
