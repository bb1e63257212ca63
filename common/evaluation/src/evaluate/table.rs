//! Prints the figures of each file as a row of a table. Pure.

use std::path::PathBuf;

use super::judge::Evaluation;
use crate::text::{number, percent, share};

/// Names and widths of the columns after the recording's name.
const COLUMNS: [(&str, usize); 18] = [
    ("cells", 9),
    ("scans", 6),
    ("truths", 6),
    ("50cm10deg %", 11),
    ("20cm3deg %", 10),
    ("top16 %", 7),
    ("unique", 6),
    ("wrong", 5),
    ("ellipse %", 9),
    ("cpu ms", 8),
    ("p90", 8),
    ("max", 8),
    ("prepare ms", 10),
    ("peak MB", 7),
    ("error m", 7),
    ("p90", 6),
    ("error deg", 9),
    ("p90", 6),
];

const NAME: &str = "recording";

pub(super) struct Table {
    name_width: usize,
}

impl Table {
    pub(super) fn of(bags: &[PathBuf]) -> Self {
        let widths = bags.iter().map(|bag| bag.display().to_string());
        let widest = widths.map(|name| name.chars().count()).max();
        Table {
            name_width: widest.unwrap_or(0).max(NAME.len()),
        }
    }

    pub(super) fn header(&self) -> String {
        self.line(NAME, &COLUMNS.map(|(name, _)| name.to_owned()))
    }

    pub(super) fn row(&self, evaluation: &Evaluation) -> String {
        let (error_m, error_deg) = (evaluation.error_m, evaluation.error_deg);
        let cells = [
            evaluation.map_cells.to_string(),
            evaluation.scans.to_string(),
            evaluation.truths.to_string(),
            percent(evaluation.success_50cm_10deg),
            percent(evaluation.success_20cm_3deg),
            percent(evaluation.top16_recall),
            evaluation.unique.to_string(),
            evaluation.unique_wrong.to_string(),
            percent(share(evaluation.unique_in_ellipse, evaluation.unique)),
            number(evaluation.cpu_ms.median, 1),
            number(evaluation.cpu_ms.p90, 1),
            number(evaluation.cpu_ms.max, 1),
            number(Some(evaluation.prepare_cpu_ms), 0),
            number(Some(evaluation.peak_rss_mb), 0),
            number(error_m.median, 3),
            number(error_m.p90, 3),
            number(error_deg.median, 2),
            number(error_deg.p90, 2),
        ];
        self.line(&evaluation.bag, &cells)
    }

    fn line(&self, name: &str, cells: &[String; COLUMNS.len()]) -> String {
        let mut line = format!("{name:<0$}", self.name_width);
        for (cell, (_, width)) in cells.iter().zip(COLUMNS) {
            line.push_str(&format!("  {cell:>width$}"));
        }
        line + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::super::judge;
    use super::*;

    #[test]
    fn columns_stand_under_their_names() {
        let table = Table::of(&["r.mcap".into(), "a/longer.mcap".into()]);
        let evaluation = judge::tests::evaluation();
        let lines = format!("\n{}{}", table.header(), table.row(&evaluation));
        assert_eq!(
            lines,
            "
recording          cells   scans  truths  50cm10deg %  20cm3deg %  top16 %  unique  wrong  ellipse %    cpu ms       p90       max  prepare ms  peak MB  error m     p90  error deg     p90
r.mcap               720       9       5         40.0        20.0     60.0       3      1       33.3       2.0       4.0       4.0          12       34    0.100   0.300       0.10    0.30
"
        );
    }

    #[test]
    fn what_is_unknown_is_a_dash() {
        let mut evaluation = judge::tests::evaluation();
        (evaluation.error_m.median, evaluation.error_m.p90) = (None, None);
        let row = Table::of(&[]).row(&evaluation);
        let cells: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(cells[15..], ["-", "-", "0.10", "0.30"]);
    }
}
