//! The tables of drives with something broken, from `backcast evaluate --sequence --stress`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::Value;

use super::figures::{NONE, percent, share_of, thousands};
use super::marks::{Cells, Figures, Place, Written};
use super::recordings::Folders;
use super::runs::{Lines, Runs};

/// The variants of the shipped corridor, those of seven drives, and the probabilities there.
pub(super) const CORRIDOR: Place = ("docs/benchmark.md", "stress");
pub(super) const DRIVES: Place = ("docs/tracking.md", "stress");
pub(super) const PROBABILITIES: Place = ("docs/tracking.md", "stress-probabilities");

/// Drives in the order of the columns, and the starts of a variant.
const EACH: [(&str, &str); 6] = [
    ("8", "malaga_courtyard/recording.mcap"),
    ("8", "jarvis_circular_nav350.mcap"),
    ("6", "csail_sequence.mcap"),
    ("8", "guardian_drawn_map.mcap"),
    ("6", "seattle_sequence.mcap"),
    ("6", "intel_sequence.mcap"),
];

/// Variants in which no pose is right.
const NOWHERE: [&str; 3] = ["map-mirrored", "map-other", "laser-mirrored"];

/// Metres after a start.
const AFTER: &str = "10";

/// Counts of one variant on some drives, or of several variants.
#[derive(Debug, Clone, Default)]
struct Counts {
    variants: u64,
    starts: u64,
    wrong_starts: u64,
    scans: u64,
    unique_scans: u64,
    wrong_scans: u64,
    losses: u64,
    /// Variants of which all starts are right.
    all_right: u64,
}

impl Counts {
    fn add(&mut self, of: &Value) {
        let count = |key: &str| of[key].as_u64().unwrap_or_default();
        self.variants += 1;
        self.starts += count("starts");
        self.wrong_starts += count("wrong_starts");
        self.scans += count("scans");
        self.unique_scans += count("unique_scans");
        self.wrong_scans += count("wrong_scans");
        self.losses += count("losses");
        self.all_right += u64::from(of["right"][AFTER] == 1.0);
    }

    fn wrong(&self) -> [String; 2] {
        let starts = format!("{} of {}", self.wrong_starts, thousands(self.starts));
        let scans = format!("{} of {}", self.wrong_scans, thousands(self.unique_scans));
        [starts, scans]
    }
}

/// Evaluates the variants of the shipped corridor, and of seven drives where there are data.
pub(super) fn measure(folders: &Folders) -> anyhow::Result<Vec<Written>> {
    const STRESS: [&str; 3] = ["--sequence", "--stress", "--starts"];
    let [corridor, courtyard, _] = folders.shipped();
    let map = courtyard.with_file_name("map.yaml");
    let map = map.to_string_lossy();
    let mut runs = Runs::default();
    let options = [&STRESS[..], &["12", "--other-map", &map]].concat();
    let first = runs.evaluate(&options, std::slice::from_ref(&corridor));
    let mut drives = Vec::new();
    if let Some(data) = &folders.data {
        let file = |name: &str| match name.starts_with("malaga") {
            true => folders.shipped.join(name),
            false => data.join(name),
        };
        let files: Vec<PathBuf> = EACH.iter().map(|(_, name)| file(name)).collect();
        for ((starts, _), file) in EACH.iter().zip(&files) {
            let options = [&STRESS[..], &[starts]].concat();
            drives.push(runs.evaluate(&options, std::slice::from_ref(file)));
        }
        let other = ["--sequence", "--stress=map-other", "--starts", "8"];
        drives.push(runs.evaluate(&other, &[&[corridor], &files[..]].concat()));
    }
    let found = runs.run(2)?;
    let mut written = vec![of_corridor(&found[first])];
    if let Some((others, drives)) = drives.split_last() {
        let is_other = |of: &&Value| of["variant"] == "map-other";
        let corridor = found[first].iter().filter(|of| !is_other(of));
        let mut columns: Vec<Vec<&Value>> = vec![corridor.collect()];
        columns.extend(drives.iter().map(|&run| found[run].iter().collect()));
        for (column, other) in columns.iter_mut().zip(&found[*others]) {
            column.push(other);
        }
        written.push(of_drives(&columns));
        written.push(probabilities(columns.iter().flatten().copied()));
    }
    Ok(written)
}

fn of_corridor(lines: &Lines) -> Written {
    let mut rows = ["some pose is right", "no pose is right"].map(|name| (name, Counts::default()));
    for of in lines {
        let is_nowhere = NOWHERE.iter().any(|name| of["variant"] == *name);
        rows[usize::from(is_nowhere)].1.add(of);
    }
    let cells = |counts: &Counts| -> Cells {
        let [starts, scans] = counts.wrong();
        let [variants, losses, right] =
            [counts.variants, counts.losses, counts.all_right].map(|count| count.to_string());
        (2..)
            .zip([variants, starts, scans, losses, right])
            .collect()
    };
    let rows = rows.map(|(name, counts)| (name.to_owned(), cells(&counts)));
    Written {
        place: CORRIDOR,
        figures: Figures::Rows(rows.to_vec()),
    }
}

/// A row for each variant, with a column for each drive.
fn of_drives(columns: &[Vec<&Value>]) -> Written {
    let mut rows: BTreeMap<&str, (Counts, Vec<String>)> = BTreeMap::new();
    let mut total = Counts::default();
    for (column, lines) in columns.iter().enumerate() {
        for of in lines {
            let variant = of["variant"].as_str().unwrap_or_default();
            let none = || (Counts::default(), vec![NONE.to_owned(); columns.len()]);
            let (counts, right) = rows.entry(variant).or_insert_with(none);
            counts.add(of);
            right[column] = percent(&of["right"][AFTER]);
            if !NOWHERE.contains(&variant) {
                total.add(of);
            }
        }
    }
    let cells = |counts: &Counts, right: Vec<String>| -> Cells {
        let [starts, scans] = counts.wrong();
        let unique = percent(&(counts.unique_scans as f64 / counts.scans as f64).into());
        let counts = [
            starts,
            scans,
            format!("{unique} %"),
            counts.losses.to_string(),
        ];
        (2..).zip(counts.into_iter().chain(right)).collect()
    };
    let all = ("all but".to_owned(), (2..).zip(total.wrong()).collect());
    let rows = rows
        .into_iter()
        .map(|(name, (counts, right))| (name.to_owned(), cells(&counts, right)));
    Written {
        place: DRIVES,
        figures: Figures::Rows(rows.chain([all]).collect()),
    }
}

/// A row for each range of probabilities that some scans had.
fn probabilities<'a>(lines: impl Iterator<Item = &'a Value>) -> Written {
    // By the lower end in per cent: scans, sum of the probabilities, and scans that were right.
    let mut ranges: BTreeMap<u64, (u64, f64, u64)> = BTreeMap::new();
    let all = lines.filter_map(|of| of["probabilities"].as_array());
    for range in all.flatten() {
        let from = (100.0 * range["from"].as_f64().unwrap_or_default()).round() as u64;
        let answers = range["answers"].as_u64().unwrap_or_default();
        let mean = range["mean"].as_f64().unwrap_or_default();
        let (scans, sum, right) = ranges.entry(from).or_default();
        *scans += answers;
        *sum += answers as f64 * mean;
        *right += range["right"].as_u64().unwrap_or_default();
    }
    let rows = ranges.into_iter().filter(|(_, (scans, ..))| *scans > 0);
    let rows = rows.map(|(from, (scans, sum, right))| {
        let figure = |share: f64| share_of(&share.into(), &scans.into()).replace(" %", "");
        let cells = [thousands(scans), figure(sum), figure(right as f64)];
        (format!("0.{from:02} to"), (2..).zip(cells).collect())
    });
    Written {
        place: PROBABILITIES,
        figures: Figures::Rows(rows.collect()),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn variants_are_summed_over_drives() {
        let line = |variant: &str, wrong: u64, right: f64| {
            json!({
                "variant": variant, "starts": 600, "wrong_starts": wrong, "scans": 2000,
                "unique_scans": 1500, "wrong_scans": wrong, "losses": 2, "right": {"10": right},
                "probabilities": [
                    {"from": 0.95, "answers": 10, "mean": 0.97, "right": 9},
                    {"from": 0.99, "answers": 0, "mean": null, "right": 0},
                ],
            })
        };
        let [glass, other, again] = [
            line("glass", 1, 1.0),
            line("map-other", 5, 0.0),
            line("glass", 2, 0.5),
        ];
        let columns = [vec![&glass, &other], vec![&again]];
        let rows = |written: Written| match written.figures {
            Figures::Rows(rows) => rows,
            Figures::Value(value) => panic!("{value}"),
        };
        let texts = |cells: &Cells| cells.iter().map(|(_, c)| c.clone()).collect::<Vec<_>>();
        let drives = rows(of_drives(&columns));
        let names: Vec<&str> = drives.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(names, ["glass", "map-other", "all but"]);
        let expected = ["3 of 1,200", "3 of 3,000", "75 %", "4", "100", "50"];
        assert_eq!(texts(&drives[0].1), expected);
        assert_eq!(texts(&drives[1].1)[4..], ["0", "–"]);
        assert_eq!(texts(&drives[2].1), expected[..2]);
        let corridor = rows(of_corridor(&vec![glass.clone(), other.clone()]));
        assert_eq!(
            texts(&corridor[0].1),
            ["1", "1 of 600", "1 of 1,500", "2", "1"]
        );
        assert_eq!(
            texts(&corridor[1].1),
            ["1", "5 of 600", "5 of 1,500", "2", "0"]
        );
        let said = rows(probabilities([&glass, &other].into_iter()));
        assert_eq!(said.len(), 1, "the range without scans is left out");
        assert_eq!(
            (&said[0].0[..], texts(&said[0].1)),
            ("0.95 to", vec!["20".into(), "97.0".into(), "90.0".into()])
        );
    }
}
