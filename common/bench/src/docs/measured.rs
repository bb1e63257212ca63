//! Which commands are run for the tables, and which of their lines become which rows.

use std::path::Path;

use anyhow::Context;
use serde_json::{Value, json};

use super::marks::Written;
use super::recordings::{DRIVES, Folders, Named, QUERIES, SHIPPED};
use super::runs::{Lines, Runs};
use super::tables::{
    ALL_TRUTHS, ALL_UNIQUE, ALL_WRONG, ELSEWHERE, ERASED, FROM_FIRST_SCAN, INTERRUPTED,
    PROBABILITIES, Rows, SCANS, SHIPPED_SCANS, SHIPPED_UNIQUE, SHIPPED_WRONG, TRACKED, value,
};

/// Measures the shipped recordings, and the evaluation data if they are given.
pub(super) fn measure(folders: &Folders) -> anyhow::Result<Vec<Written>> {
    let mut runs = Runs::default();
    let of_data = folders
        .data
        .is_some()
        .then(|| Data::plan(folders, &mut runs));
    let trajectories = tempfile::tempdir().context("cannot make a folder for trajectories")?;
    let folder = trajectories.path();
    let scans = runs.evaluate(&[], &folders.shipped());
    let drives = folders.shipped().map(|drive| {
        let folder = folder_of(folder, &drive);
        runs.evaluate(&["--sequence", "--trajectories", &folder], &[drive])
    });
    let found = runs.run(2)?;
    let mut runs = Runs::default();
    for drive in folders.shipped() {
        let tracked = format!("{}/recording.tum", folder_of(folder, &drive));
        let options = ["--answers", &tracked, "--answers-of", "laser"];
        runs.evaluate(&options, &[drive]);
    }
    let tracked: Lines = runs.run(2)?.concat();
    let drives: Lines = drives.iter().flat_map(|&run| found[run].clone()).collect();
    let mut written = of_shipped(&found[scans], &named(&SHIPPED, &drives));
    written.push(FROM_FIRST_SCAN.of(&named(&SHIPPED, &tracked)));
    if let Some(data) = of_data {
        written.extend(data.figures(&found));
    }
    Ok(written)
}

/// Folder for the trajectory of a drive, named as the recording's folder.
fn folder_of(trajectories: &Path, drive: &Path) -> String {
    let name = drive.parent().and_then(Path::file_name).unwrap_or_default();
    trajectories.join(name).display().to_string()
}

fn of_shipped(scans: &Lines, drives: &Rows) -> Vec<Written> {
    let (_, total) = all(scans);
    let rows = named(&SHIPPED, scans);
    let mut written: Vec<_> = SHIPPED_SCANS.iter().map(|table| table.of(&rows)).collect();
    written.extend([
        value(SHIPPED_UNIQUE, &total["unique"]),
        value(SHIPPED_WRONG, &total["unique_wrong"]),
        TRACKED.of(drives),
        INTERRUPTED.of(drives),
    ]);
    written
}

/// Rows of recordings, whose lines come in the same order.
fn named(recordings: &[Named], lines: &[Value]) -> Rows {
    let names = recordings.iter().map(|(name, _)| (*name).to_owned());
    names.zip(lines.iter().cloned()).collect()
}

/// Runs with the evaluation data, by their numbers.
struct Data {
    drives: [usize; DRIVES.len()],
    /// All queries and the shipped recordings.
    scans: usize,
    erased: usize,
    /// The scans of each building on the maps of four others.
    elsewhere: [[usize; 4]; QUERIES.len()],
}

impl Data {
    fn plan(folders: &Folders, runs: &mut Runs) -> Self {
        let shipped = folders.shipped();
        let data = folders.data.clone().unwrap_or_default();
        let queries = QUERIES.map(|(_, file)| data.join(file));
        let drives = DRIVES.map(|(_, file)| {
            let mut options = vec!["--sequence"];
            if file == "guardian_two_lasers.mcap" {
                options.extend(["--scan-topic", "/front/scan", "--scan-topic", "/rear/scan"]);
            }
            runs.evaluate(&options, &[data.join(file)])
        });
        let scans = runs.evaluate(&[], &[&queries[..], &shipped].concat());
        let erased = runs.evaluate(&["--erase-place", "2.5", "--every", "2"], &queries);
        let elsewhere = std::array::from_fn(|building| {
            // Two other buildings, every second scan, and two shipped recordings, every sixth.
            let other = |next: usize| (&queries[(building + next) % queries.len()], "2");
            let others = [other(1), other(2), (&shipped[0], "6"), (&shipped[1], "6")];
            others.map(|(map, every)| runs.locate(&["--every", every], &queries[building], map))
        });
        Data {
            drives,
            scans,
            erased,
            elsewhere,
        }
    }

    fn figures(&self, found: &[Lines]) -> Vec<Written> {
        let drives = self.drives.map(|run| found[run][0].clone());
        let drives = named(&DRIVES, &drives);
        let scans = &found[self.scans];
        let mut erased = named(&QUERIES, &found[self.erased]);
        erased.push(all(&found[self.erased]));
        let (_, total) = all(scans);
        vec![
            TRACKED.of(&drives),
            INTERRUPTED.of(&drives),
            SCANS.of(&named(&QUERIES, scans)),
            PROBABILITIES.of(&probabilities(&total)),
            value(ALL_TRUTHS, &total["truths"]),
            value(ALL_UNIQUE, &total["unique"]),
            value(ALL_WRONG, &total["unique_wrong"]),
            ERASED.of(&erased),
            ELSEWHERE.of(&self.verdicts(found)),
        ]
    }

    /// Counts the verdicts on the scans of each building, and on all.
    fn verdicts(&self, found: &[Lines]) -> Rows {
        let counts = |answers: &[&Value]| {
            let count = |verdict: &str| {
                let answers = answers.iter();
                answers
                    .filter(|answer| answer["verdict"] == verdict)
                    .count()
            };
            json!({
                "scans": answers.len(),
                "Unique": count("Unique"),
                "Ambiguous": count("Ambiguous"),
                "PoorFit": count("PoorFit"),
            })
        };
        let (mut all, mut rows) = (Vec::new(), Rows::new());
        for ((name, _), runs) in QUERIES.iter().zip(self.elsewhere) {
            let answers: Vec<&Value> = runs.iter().flat_map(|run| &found[*run]).collect();
            rows.push(((*name).to_owned(), counts(&answers)));
            all.extend(answers);
        }
        rows.push(("all".to_owned(), counts(&all)));
        rows
    }
}

/// Row of the total of all files, which is the last line.
fn all(lines: &Lines) -> (String, Value) {
    let last = lines.last().unwrap_or(&Value::Null);
    ("all".to_owned(), last["total"].clone())
}

/// Row of each range of probabilities, named by its lower end.
fn probabilities(total: &Value) -> Rows {
    let ranges = total["probabilities"].as_array();
    let ranges = ranges.into_iter().flatten().map(|range| {
        let end = |end: &str| range[end].as_f64().unwrap_or_default();
        let name = match end("from") {
            0.0 => format!("below {:.2}", end("to")),
            from => format!("{from:.2} to"),
        };
        (name, range.clone())
    });
    ranges.collect()
}
