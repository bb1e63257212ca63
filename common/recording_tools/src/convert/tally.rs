//! Counts the lines of a log that are not converted, by kind.

use std::collections::BTreeMap;

use super::carmen::{Broken, Fault};

/// Largest number of names of other kinds; a file that is no log has as many as it has lines.
const MAX_NAMES: usize = 100;

/// Number of other kinds that are listed, those with most lines first.
const SHOWN: usize = 6;

const MAX_NAME: usize = 32;

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Tally {
    /// Broken lines of known kinds, by name and fault.
    broken: BTreeMap<(String, Fault), u64>,
    pub(super) first_broken: Option<String>,
    others: BTreeMap<String, u64>,
    /// Lines that do not start like any line of a log.
    not_lines: u64,
    /// Lines of kinds that repeat scans of other lines.
    repeated: BTreeMap<String, u64>,
    /// Ranges that are no numbers.
    pub(super) missing_readings: u64,
}

impl Tally {
    pub(super) fn broken(&mut self, number: u64, broken: &Broken) {
        let key = (broken.name.clone(), broken.fault);
        *self.broken.entry(key).or_default() += 1;
        self.first_broken
            .get_or_insert_with(|| format!("line {number}, {}: {}", broken.name, broken.reason));
    }

    pub(super) fn other(&mut self, name: &str) {
        let is_name =
            |byte: u8| byte.is_ascii_uppercase() || byte.is_ascii_digit() || b"_-".contains(&byte);
        let is_known = self.others.contains_key(name);
        if name.len() <= MAX_NAME
            && name.bytes().all(is_name)
            && (is_known || self.others.len() < MAX_NAMES)
        {
            *self.others.entry(name.to_owned()).or_default() += 1;
        } else {
            self.not_lines += 1;
        }
    }

    pub(super) fn repeated(&mut self, name: String) {
        *self.repeated.entry(name).or_default() += 1;
    }

    pub(super) fn broken_lines(&self) -> u64 {
        self.broken.values().sum()
    }

    /// Describes all of it in words; `None` if nothing is left out.
    pub(super) fn text(&self) -> Option<String> {
        let mut parts = Vec::new();
        for ((name, fault), count) in &self.broken {
            let what = match fault {
                Fault::CutShort => "cut short",
                Fault::Count => "with a wrong count",
                Fault::Number => "with what is no number",
                Fault::Time => "with a wrong time",
                Fault::Angles => "with wrong angles",
            };
            parts.push(format!("{} {what}", lines(*count, name)));
        }
        for (name, count) in &self.repeated {
            parts.push(format!(
                "{} whose scans stand in other lines, too",
                lines(*count, name)
            ));
        }
        if !self.others.is_empty() {
            parts.push(self.others_text());
        }
        if self.not_lines > 0 {
            parts.push(format!(
                "{} that no log of CARMEN has",
                lines(self.not_lines, "")
            ));
        }
        (!parts.is_empty()).then(|| parts.join(", "))
    }

    fn others_text(&self) -> String {
        let mut others: Vec<_> = self.others.iter().collect();
        // The sort is stable: equal counts stay in the order of their names.
        others.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let total = others.iter().map(|(_, count)| **count).sum();
        let shown = others.iter().take(SHOWN);
        let shown: Vec<String> = shown
            .map(|(name, count)| format!("{count} {name}"))
            .collect();
        let more = match others.len().saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more kinds"),
        };
        let (lines, shown) = (lines(total, ""), shown.join(", "));
        format!("{lines} of kinds that are not converted ({shown}{more})")
    }
}

fn lines(count: u64, name: &str) -> String {
    let space = if name.is_empty() { "" } else { " " };
    let plural = if count == 1 { "" } else { "s" };
    format!("{count}{space}{name} line{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_reported_by_kind() {
        let mut tally = Tally::default();
        assert_eq!(tally.text(), None);
        let broken = |name: &str, fault| Broken {
            name: name.to_owned(),
            fault,
            reason: "it ends".to_owned(),
        };
        tally.broken(5, &broken("FLASER", Fault::CutShort));
        tally.broken(7, &broken("FLASER", Fault::CutShort));
        tally.broken(8, &broken("ODOM", Fault::Time));
        for other in ["TRUEPOS", "GPS", "TRUEPOS", "hello", "\u{fffd}\u{fffd}"] {
            tally.other(other);
        }
        tally.repeated("RAWLASER1".to_owned());
        assert_eq!(tally.broken_lines(), 3);
        assert_eq!(
            tally.first_broken.as_deref(),
            Some("line 5, FLASER: it ends")
        );
        assert_eq!(
            tally.text().unwrap(),
            "2 FLASER lines cut short, 1 ODOM line with a wrong time, 1 RAWLASER1 line whose scans \
             stand in other lines, too, 3 lines of kinds that are not converted (2 TRUEPOS, 1 GPS), \
             2 lines that no log of CARMEN has"
        );
    }

    #[test]
    fn many_kinds_are_cut() {
        let mut tally = Tally::default();
        for index in 0..300 {
            tally.other(&format!("KIND{index}"));
        }
        assert_eq!(
            tally.text().unwrap(),
            "100 lines of kinds that are not converted (1 KIND0, 1 KIND1, 1 KIND10, 1 KIND11, 1 \
             KIND12, 1 KIND13 and 94 more kinds), 200 lines that no log of CARMEN has"
        );
    }
}
