//! Figures of the shipped recordings in the tables of the documents, compared with what
//! `backcast evaluate` says. Times, which depend on the machine, stay as they are.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;
use tests::{executables, root};

use crate::read;

const RECORDINGS: [&str; 3] = ["malaga_corridor", "malaga_courtyard", "malaga_campus"];

/// A table with a row for each recording.
struct Table {
    page: &'static str,
    /// Start of its first line.
    head: &'static str,
    /// True if it is of `evaluate --sequence`, else of single scans.
    is_sequence: bool,
    /// Columns with figures, and the figures of a recording.
    figures: fn(&Value) -> Vec<(usize, String)>,
}

const TABLES: [Table; 6] = [
    Table {
        page: "README.md",
        head: "| recording | cells |",
        is_sequence: false,
        figures: |of| {
            vec![
                (3, number(&of["truths"])),
                (4, share(&of["success_50cm_10deg"])),
                (5, share(&of["success_20cm_3deg"])),
                (7, centimetres(of)),
            ]
        },
    },
    Table {
        page: "docs/accuracy.md",
        head: "| recording | truths | within",
        is_sequence: false,
        figures: |of| {
            vec![
                (2, number(&of["truths"])),
                (3, share(&of["success_50cm_10deg"])),
                (4, number(&of["unique"])),
                (5, number(&of["unique_wrong"])),
                (6, centimetres(of)),
            ]
        },
    },
    Table {
        page: "docs/benchmark.md",
        head: "| recording | truths | found |",
        is_sequence: false,
        figures: |of| {
            let (metres, degrees) = (of["error_m"]["median"].as_f64(), &of["error_deg"]["median"]);
            vec![
                (2, number(&of["truths"])),
                (3, share(&of["success_50cm_10deg"])),
                (4, share(&of["success_20cm_3deg"])),
                (5, number(&of["unique"])),
                (6, number(&of["unique_wrong"])),
                (7, format!("{:.3} m, {}", metres.unwrap(), turn(degrees))),
            ]
        },
    },
    Table {
        page: "docs/benchmark.md",
        head: "| recording | truths | answered |",
        is_sequence: true,
        figures: |of| {
            let ape = &of["from_first_scan"]["ape_m"];
            let (rmse, most) = (ape["rmse"].as_f64().unwrap(), ape["max"].as_f64().unwrap());
            let step = of["from_first_scan"]["rpe_m"]["rmse"].as_f64().unwrap();
            let turned = turn(&of["from_first_scan"]["rpe_deg"]["rmse"]);
            vec![
                (2, number(&of["truths"])),
                (3, number(&of["from_first_scan"]["poses"])),
                (6, format!("{rmse:.3} / {most:.3} m")),
                (7, format!("{step:.3} m, {turned}")),
            ]
        },
    },
    Table {
        page: "docs/tracking.md",
        head: "| drive | 1 m | 2 m |",
        is_sequence: true,
        figures: |of| {
            let metres = ["1", "2", "5", "10", "20"];
            let right = metres.map(|metres| percent(&of["right"][metres]));
            let mut figures: Vec<_> = (2..).zip(right).collect();
            let rms = 100.0 * of["rms_m"].as_f64().unwrap();
            figures.extend([
                (7, number(&of["wrong_starts"])),
                (8, number(&of["losses"])),
                (9, format!("{rms:.1} cm {}", turn(&of["rms_deg"]))),
                (10, format!("{} %", percent(&of["in_ellipse"]))),
            ]);
            figures
        },
    },
    Table {
        page: "docs/tracking.md",
        head: "| drive | noticed |",
        is_sequence: true,
        figures: |of| {
            let wrong = |what: &str| {
                let wrong = number(&of[format!("{what}_wrong")]);
                format!("{wrong} of {}", number(&of[what]))
            };
            vec![
                (2, percent(&of["kidnaps_noticed_within_2"])),
                (3, percent(&of["kidnaps_right_after_5_m"])),
                (4, wrong("kidnaps")),
                (5, percent(&of["outages_right_after_5_m"])),
                (6, wrong("outages")),
            ]
        },
    },
];

fn number(value: &Value) -> String {
    value.as_u64().unwrap().to_string()
}

/// Whole per cent; a dash without a value.
fn percent(share: &Value) -> String {
    let percent = share.as_f64().map(|share| format!("{:.0}", 100.0 * share));
    percent.unwrap_or("–".to_owned())
}

/// Per cent with a digit behind the point, unless all.
fn share(share: &Value) -> String {
    let percent = format!("{:.1} %", 100.0 * share.as_f64().unwrap());
    percent.replace("100.0", "100")
}

fn turn(degrees: &Value) -> String {
    format!("{:.2}°", degrees.as_f64().unwrap())
}

/// Median errors of the scans that were found.
fn centimetres(of: &Value) -> String {
    let metres = of["error_m"]["median"].as_f64().unwrap();
    let turned = turn(&of["error_deg"]["median"]);
    format!("{:.1} cm, {turned}", 100.0 * metres)
}

/// Returns what `evaluate` says of a recording.
fn evaluate(name: &str, is_sequence: bool) -> Value {
    let recording = root().join("recordings").join(name).join("recording.mcap");
    let output = Command::new(executables::path("backcast"))
        .args(["evaluate", "--json"])
        .args(is_sequence.then_some("--sequence"))
        .arg(recording)
        .output()
        .unwrap();
    assert!(output.status.success(), "{name}: {output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Returns the name of a recording at the start of a row.
fn recording_of(row: &str) -> Option<&'static str> {
    let name = row.strip_prefix("| ")?.trim_start_matches('`');
    let end = name.find(|c: char| !c.is_alphanumeric() && c != '_')?;
    RECORDINGS.into_iter().find(|&known| known == &name[..end])
}

/// Writes the figures into the rows of a table. Returns the text and the number of rows with a
/// recording.
fn written(text: &str, table: &Table, of: impl Fn(&str) -> Value) -> (String, usize) {
    let (mut is_inside, mut rows) = (false, 0);
    let mut lines = Vec::new();
    for line in text.lines() {
        is_inside = line.starts_with(table.head) || is_inside && line.starts_with('|');
        let Some(recording) = recording_of(line).filter(|_| is_inside) else {
            lines.push(line.to_owned());
            continue;
        };
        rows += 1;
        let mut cells: Vec<String> = line.split('|').map(str::to_owned).collect();
        for (column, figure) in (table.figures)(&of(recording)) {
            cells[column] = format!(" {figure} ");
        }
        lines.push(cells.join("|"));
    }
    (lines.join("\n") + "\n", rows)
}

#[test]
fn figures_of_the_shipped_recordings_are_those_of_evaluate() {
    let mut said = BTreeMap::new();
    for name in RECORDINGS {
        for is_sequence in [false, true] {
            said.insert((name, is_sequence), evaluate(name, is_sequence));
        }
    }
    for table in &TABLES {
        let path = root().join(table.page);
        let text = read(&path);
        let of = |name: &str| {
            let found = said
                .iter()
                .find(|((known, is), _)| *known == name && *is == table.is_sequence);
            found.unwrap().1.clone()
        };
        let (made, rows) = written(&text, table, of);
        assert_eq!(rows, RECORDINGS.len(), "{}: {}", table.page, table.head);
        if std::env::var_os("BACKCAST_ACCEPT").is_some() {
            std::fs::write(&path, made).unwrap();
            continue;
        }
        let differing = text.lines().zip(made.lines()).find(|(old, new)| old != new);
        assert_eq!(
            differing, None,
            "{}: write it anew by BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents",
            table.page
        );
    }
}
