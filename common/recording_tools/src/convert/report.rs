//! Summary of a conversion, with the lines of a log that are not converted.

use std::collections::BTreeMap;

use super::carmen::Broken;

/// Largest number of kinds; a file that is no log has as many as it has lines.
const MAX_KINDS: usize = 100;

/// Number of kinds that are listed, those with most lines first.
const SHOWN: usize = 8;

const MAX_NAME: usize = 32;

const NO_LINE: &str = "what no log of CARMEN has";

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Report {
    pub(super) scans: u64,
    pub(super) odometry: u64,
    /// Number of messages of a bag, of any type.
    pub(super) messages: u64,
    /// Descriptions of the lasers, one line each.
    pub(super) remarks: Vec<String>,
    /// Numbers of lines that are not converted, by kind.
    pub(super) left_out: BTreeMap<String, u64>,
    pub(super) broken_lines: u64,
    /// The first line that cannot be read: its number, name and fault.
    pub(super) first_broken: Option<(u64, String)>,
    /// Ranges that are no numbers.
    pub(super) missing_readings: u64,
    pub(super) damage: Option<String>,
    /// Number of scans with another mount than the first one of their laser.
    pub(super) moved_mounts: u64,
}

impl Report {
    pub(super) fn leave_out(&mut self, kind: &str) {
        let is_listed = self.left_out.len() < MAX_KINDS || self.left_out.contains_key(kind);
        let kind = if is_listed { kind } else { NO_LINE };
        *self.left_out.entry(kind.to_owned()).or_default() += 1;
    }

    /// Counts a line of a kind that is not converted, by its name.
    pub(super) fn other(&mut self, name: &str) {
        let is_name =
            |byte: u8| byte.is_ascii_uppercase() || byte.is_ascii_digit() || b"_-".contains(&byte);
        let is_line = name.len() <= MAX_NAME && name.bytes().all(is_name);
        self.leave_out(if is_line { name } else { NO_LINE });
    }

    pub(super) fn broken(&mut self, number: u64, broken: &Broken) {
        let Broken {
            name,
            fault,
            reason,
        } = broken;
        self.leave_out(&format!("{name} {fault}"));
        self.broken_lines += 1;
        let first = self.first_broken.as_ref();
        if first.is_none_or(|&(first, _)| number < first) {
            self.first_broken = Some((number, format!("{name}: {reason}")));
        }
    }

    /// Lines that are not converted, in words; `None` if all are.
    pub(super) fn left_out(&self) -> Option<String> {
        let mut kinds: Vec<_> = self.left_out.iter().collect();
        // The sort is stable: equal counts stay in the order of their names.
        kinds.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let shown = kinds.iter().take(SHOWN);
        let shown: Vec<String> = shown
            .map(|(kind, count)| format!("{kind} ({count})"))
            .collect();
        let more = match kinds.len().saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more kinds"),
        };
        (!kinds.is_empty()).then(|| format!("lines left out: {}{more}", shown.join(", ")))
    }

    pub(super) fn losses(&self) -> Vec<String> {
        let mut losses = Vec::new();
        if let Some((first, fault)) = &self.first_broken {
            let lines = self.broken_lines;
            losses.push(format!(
                "lines that could not be read: {lines}; the first, line {first}, {fault}"
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
        reasons.extend(self.left_out());
        reasons.extend(self.losses());
        match reasons.is_empty() {
            true => "it is empty".to_owned(),
            false => reasons.join("; "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_left_out_are_counted_by_kind() {
        let mut report = Report::default();
        assert_eq!((report.left_out(), report.losses()), (None, Vec::new()));
        for (number, name) in [(5, "FLASER"), (7, "FLASER"), (8, "ODOM")] {
            let broken = Broken {
                name: name.to_owned(),
                fault: "cut short",
                reason: "it ends".to_owned(),
            };
            report.broken(number, &broken);
        }
        for other in ["TRUEPOS", "TRUEPOS", "TRUEPOS", "hello", "\u{fffd}"] {
            report.other(other);
        }
        let expected = "lines left out: TRUEPOS (3), FLASER cut short (2), what no log of CARMEN \
                        has (2), ODOM cut short (1)";
        assert_eq!(report.left_out().unwrap(), expected);
        let first = "lines that could not be read: 3; the first, line 5, FLASER: it ends";
        assert_eq!(report.losses(), [first]);
        for index in 0..300 {
            report.other(&format!("KIND{index}"));
        }
        let many = report.left_out().unwrap();
        let (begin, end) = ("lines left out: what no log of CARMEN has (206), ", "kinds");
        assert!(many.starts_with(begin) && many.ends_with(end), "{many}");
    }
}
