//! Figures in the tables of the documents, compared with what `backcast evaluate` says: of the
//! shipped recordings always, of those that are not in the repository where they are. Times, which
//! depend on the machine, stay as they are.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use serde_json::Value;
use tests::{evaluation_data, executables, json_lines_of, root};

use crate::read;

/// Recordings by the start of their rows: the shipped ones, and files of the evaluation data.
const SHIPPED: [(&str, &str); 3] = [
    ("malaga_corridor", "malaga_corridor/recording.mcap"),
    ("malaga_courtyard", "malaga_courtyard/recording.mcap"),
    ("malaga_campus", "malaga_campus/recording.mcap"),
];
const QUERIES: [(&str, &str); 6] = [
    ("Intel Lab", "intel_queries.mcap"),
    ("Freiburg 079", "fr079_queries.mcap"),
    ("MIT CSAIL", "csail_queries.mcap"),
    ("ACES", "aces_queries.mcap"),
    ("Seattle", "seattle_queries.mcap"),
    ("Wean Hall", "wean_queries.mcap"),
];
const DRIVES: [(&str, &str); 8] = [
    ("intel", "intel_sequence.mcap"),
    ("csail", "csail_sequence.mcap"),
    ("fr079", "fr079_sequence.mcap"),
    ("seattle", "seattle_sequence.mcap"),
    ("wean", "wean_sequence1.mcap"),
    ("jarvis", "jarvis_circular_nav350.mcap"),
    ("guardian, drawn", "guardian_drawn_map.mcap"),
    ("guardian, two", "guardian_two_lasers.mcap"),
];

/// A table with a row for each recording.
struct Table {
    page: &'static str,
    /// Start of its first line.
    head: &'static str,
    /// Columns with figures, and the figures of a recording.
    figures: fn(&Value) -> Vec<(usize, String)>,
}

const SCANS: [Table; 3] = [
    Table {
        page: "README.md",
        head: "| recording | cells |",
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
        figures: |of| {
            vec![
                (2, number(&of["truths"])),
                (3, share(&of["success_50cm_10deg"])),
                (4, number(&of["unique"])),
                (5, number(&of["unique_wrong"])),
                (6, centimetres(of)),
                (7, in_ellipse(of)),
            ]
        },
    },
    Table {
        page: "docs/benchmark.md",
        head: "| recording | truths | found |",
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
];

const SCANS_OF_DATA: Table = Table {
    page: "docs/accuracy.md",
    head: "| data | truths | within",
    figures: |of| {
        let unique = of["unique"].as_f64().unwrap() / of["truths"].as_f64().unwrap();
        vec![
            (2, number(&of["truths"])),
            (3, share(&of["success_50cm_10deg"])),
            (4, share(&of["top16_recall"])),
            (5, share(&unique.into())),
            (6, number(&of["unique_wrong"])),
            (7, centimetres(of)),
            (8, in_ellipse(of)),
        ]
    },
};

/// Scans whose place was made unknown on the map.
const ERASED: Table = Table {
    page: "docs/accuracy.md",
    head: "| place erased | scans |",
    figures: |of| {
        let columns = [&of["truths"], &of["unique"], &of["unique_wrong"]];
        (2..).zip(columns.map(number)).collect()
    },
};

/// Scans on the maps of other buildings.
const ELSEWHERE: Table = Table {
    page: "docs/accuracy.md",
    head: "| scans of | on the maps of |",
    figures: |of| {
        let verdicts = ["scans", "Unique", "Ambiguous", "PoorFit"];
        (3..)
            .zip(verdicts.map(|verdict| number(&of[verdict])))
            .collect()
    },
};

/// How the probabilities turned out.
const PROBABILITIES: Table = Table {
    page: "docs/accuracy.md",
    head: "| probability | answers |",
    figures: |of| {
        let answers = of["answers"].as_f64().unwrap();
        let right = of["right"].as_f64().unwrap() / answers;
        vec![
            (2, number(&of["answers"])),
            (3, share(&of["mean"])),
            (4, share(&right.into())),
        ]
    },
};

const BENCHMARK_DRIVES: Table = Table {
    page: "docs/benchmark.md",
    head: "| recording | truths | answered |",
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
};

const TRACKED: Table = Table {
    page: "docs/tracking.md",
    head: "| drive | 1 m | 2 m |",
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
};

const INTERRUPTED: Table = Table {
    page: "docs/tracking.md",
    head: "| drive | noticed |",
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
};

fn number(value: &Value) -> String {
    value.as_u64().unwrap_or(0).to_string()
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

/// Share of the `Unique` whose true position is in the ellipse of 95 %.
fn in_ellipse(of: &Value) -> String {
    let held = of["unique_in_ellipse"].as_f64().unwrap();
    share(&(held / of["unique"].as_f64().unwrap()).into())
}

/// Returns what `evaluate` says of recordings with these options, a value for each and, of several,
/// one of all.
fn evaluate(options: &[&str], recordings: &[PathBuf]) -> Vec<Value> {
    let mut command = Command::new(executables::path("backcast"));
    json_lines_of(
        command
            .args(["evaluate", "--json"])
            .args(options)
            .args(recordings),
    )
}

/// Rows of recordings, each with what `evaluate` says of it.
type Rows<'a> = Vec<(&'a str, Value)>;

/// Evaluates recordings in a folder.
fn rows_of<'a>(options: &[&str], folder: &Path, named: &[(&'a str, &str)]) -> Rows<'a> {
    let files: Vec<_> = named.iter().map(|(_, file)| folder.join(file)).collect();
    let said = evaluate(options, &files);
    named.iter().map(|(row, _)| *row).zip(said).collect()
}

/// Writes the figures into the rows of a table. Returns the text and the number of rows that were
/// written.
fn written(text: &str, table: &Table, rows: &Rows<'_>) -> (String, usize) {
    let (mut is_inside, mut count) = (false, 0);
    let mut lines = Vec::new();
    for line in text.lines() {
        is_inside = line.starts_with(table.head) || is_inside && line.starts_with('|');
        let name = line.strip_prefix("| ").unwrap_or_default();
        let name = name.trim_start_matches('`');
        let row = rows.iter().find(|(row, _)| name.starts_with(row));
        let Some((_, of)) = row.filter(|_| is_inside) else {
            lines.push(line.to_owned());
            continue;
        };
        count += 1;
        let mut cells: Vec<String> = line.split('|').map(str::to_owned).collect();
        for (column, figure) in (table.figures)(of) {
            cells[column] = format!(" {figure} ");
        }
        lines.push(cells.join("|"));
    }
    (lines.join("\n") + "\n", count)
}

/// Tables of one page are written by tests that run at the same time.
static WRITING: Mutex<()> = Mutex::new(());

/// Compares a page with what `make` makes of it, or writes that if it is to be accepted.
fn compare(page: &str, make: impl FnOnce(&str) -> String) {
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let path = root().join(page);
    let text = read(&path);
    let made = make(&text);
    if std::env::var_os("BACKCAST_ACCEPT").is_some() {
        return std::fs::write(&path, made).unwrap();
    }
    let differing = text.lines().zip(made.lines()).find(|(old, new)| old != new);
    assert_eq!(
        differing, None,
        "{page}: BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents writes it"
    );
}

fn compare_table(table: &Table, rows: &Rows<'_>) {
    compare(table.page, |text| {
        let (made, count) = written(text, table, rows);
        assert_eq!(count, rows.len(), "{}: {}", table.page, table.head);
        made
    });
}

#[test]
fn figures_of_the_shipped_recordings_are_those_of_evaluate() {
    let folder = root().join("recordings");
    let scans = rows_of(&[], &folder, &SHIPPED);
    SCANS.iter().for_each(|table| compare_table(table, &scans));
    let drives = rows_of(&["--sequence"], &folder, &SHIPPED);
    for table in [&BENCHMARK_DRIVES, &TRACKED, &INTERRUPTED] {
        compare_table(table, &drives);
    }
}

#[test]
fn figures_of_single_scans_of_the_evaluation_data_are_those_of_evaluate() {
    let Some(data) = evaluation_data("documents figures of single scans") else {
        return;
    };
    let queries = QUERIES.map(|(_, file)| data.join(file));
    let recordings = root().join("recordings");
    let shipped = SHIPPED.map(|(_, file)| recordings.join(file));
    let said = evaluate(&[], &[&queries[..], &shipped].concat());
    let rows = QUERIES.iter().map(|(row, _)| *row).zip(said.clone());
    compare_table(&SCANS_OF_DATA, &rows.collect());
    let all = &said.last().unwrap()["total"]["probabilities"];
    let ranges = all.as_array().unwrap().iter().rev().map(|range| {
        let name = match range["from"].as_f64().unwrap() {
            0.0 => format!("below {:.2}", range["to"].as_f64().unwrap()),
            from => format!("{from:.2} to"),
        };
        (name, range.clone())
    });
    let ranges: Vec<_> = ranges.collect();
    let ranges = ranges
        .iter()
        .map(|(name, range)| (&name[..], range.clone()));
    compare_table(&PROBABILITIES, &ranges.collect());
}

#[test]
fn figures_of_scans_of_other_places_are_those_of_evaluate() {
    let Some(data) = evaluation_data("documents figures of other places") else {
        return;
    };
    let queries = QUERIES.map(|(_, file)| data.join(file));
    let recordings = root().join("recordings");
    let shipped = SHIPPED.map(|(_, file)| recordings.join(file));
    let erased = evaluate(&["--erase-place", "2.5", "--every", "2"], &queries);
    let mut rows: Rows<'_> = QUERIES
        .iter()
        .map(|(row, _)| *row)
        .zip(erased.clone())
        .collect();
    rows.push(("all", erased.last().unwrap()["total"].clone()));
    compare_table(&ERASED, &rows);

    let mut total = serde_json::Map::new();
    let mut rows = Vec::new();
    for (number, (row, _)) in QUERIES.iter().enumerate() {
        // Two other buildings, every second scan, and two shipped recordings, every sixth.
        let others = [1, 2].map(|next| (&queries[(number + next) % queries.len()], "2"));
        let others = others
            .into_iter()
            .chain(shipped[..2].iter().map(|map| (map, "6")));
        let mut counts = serde_json::Map::new();
        for (map, every) in others {
            let mut locate = Command::new(executables::path("backcast"));
            locate.args(["locate", "--json", "--every", every, "--bag"]);
            let answers = json_lines_of(locate.arg(&queries[number]).arg("--map").arg(map));
            for answer in answers {
                for counted in ["scans", answer["verdict"].as_str().unwrap()] {
                    for counts in [&mut counts, &mut total] {
                        let count = counts.get(counted).and_then(Value::as_u64);
                        counts.insert(counted.to_owned(), (count.unwrap_or(0) + 1).into());
                    }
                }
            }
        }
        rows.push((*row, Value::Object(counts)));
    }
    rows.push(("all", Value::Object(total)));
    compare_table(&ELSEWHERE, &rows);
}

#[test]
fn figures_of_drives_of_the_evaluation_data_are_those_of_evaluate() {
    let Some(data) = evaluation_data("documents figures of drives") else {
        return;
    };
    let said = |file: &str| {
        let lasers: &[&str] = match file {
            "guardian_two_lasers.mcap" => &["/front/scan", "/rear/scan"],
            _ => &[],
        };
        let lasers = lasers.iter().flat_map(|topic| ["--scan-topic", topic]);
        let options: Vec<_> = std::iter::once("--sequence").chain(lasers).collect();
        evaluate(&options, &[data.join(file)]).remove(0)
    };
    let drives: Rows<'_> = std::thread::scope(|scope| {
        let each = DRIVES.map(|(row, file)| (row, scope.spawn(|| said(file))));
        each.into_iter()
            .map(|(row, said)| (row, said.join().unwrap()))
            .collect()
    });
    compare_table(&TRACKED, &drives);
    compare_table(&INTERRUPTED, &drives);
}

/// Shares of the scans that are found, a set at a time, and how many are `Unique` and wrong.
struct Outcome {
    found: Vec<f64>,
    unique: u64,
    wrong: u64,
}

impl Outcome {
    fn of(options: &[&str], files: &[PathBuf]) -> Self {
        let said = evaluate(&[&["--every", "5"], options].concat(), files);
        let found = said.iter().take(files.len());
        let total = &said.last().unwrap()["total"];
        Outcome {
            found: found
                .map(|of| of["success_50cm_10deg"].as_f64().unwrap())
                .collect(),
            unique: total["unique"].as_u64().unwrap(),
            wrong: total["unique_wrong"].as_u64().unwrap(),
        }
    }

    /// Mean over the sets, without one if it is given.
    fn mean(&self, without: Option<usize>) -> f64 {
        let sets = self.found.iter().enumerate();
        let kept = sets.filter(|&(set, _)| Some(set) != without);
        let (count, sum) = kept.fold((0.0, 0.0), |(n, sum), (_, found)| (n + 1.0, sum + found));
        sum / count
    }
}

/// Mean share that is found on each set with the value that is best on the others.
fn left_out(values: &[&Outcome]) -> f64 {
    let sets = values[0].found.len();
    let of_set = (0..sets).map(|set| {
        let better = |best: &'_ Outcome, next: &'_ Outcome| {
            next.mean(Some(set)) > best.mean(Some(set)) + 1e-9
        };
        let best = values
            .iter()
            .copied()
            .reduce(|best, next| match better(best, next) {
                true => next,
                false => best,
            });
        best.unwrap().found[set]
    });
    of_set.sum::<f64>() / sets as f64
}

#[test]
#[ignore = "takes some minutes: run it by name when the engine's answers have changed"]
fn figures_of_the_constants_are_those_of_evaluate() {
    let data = evaluation_data("documents figures of constants").unwrap();
    let recordings = root().join("recordings");
    let shipped = SHIPPED[..2].iter().map(|(_, file)| recordings.join(file));
    let files: Vec<_> = QUERIES
        .iter()
        .map(|(_, file)| data.join(file))
        .chain(shipped)
        .collect();
    let default = Outcome::of(&[], &files);
    let cell = |of: &Outcome| format!("{}, {}", share(&of.mean(None).into()), of.unique);
    compare("docs/accuracy.md", |text| {
        let mut is_inside = false;
        let lines = text.lines().map(|line| {
            is_inside = line.starts_with("| constant |") || is_inside && line.starts_with('|');
            let mut cells: Vec<String> = line.split('|').map(str::to_owned).collect();
            let option = cells
                .get(1)
                .map(|cell| cell.trim().trim_matches('`').to_owned());
            let Some(option) = option
                .filter(|option| is_inside && option.starts_with("--") && line.contains(": "))
            else {
                return line.to_owned();
            };
            let other = |old: &str| {
                let value = old.split(':').next().unwrap().trim().to_owned();
                let outcome = Outcome::of(&[&option, &value], &files);
                assert_eq!(outcome.wrong, 0, "{option} {value}");
                (format!(" {value}: {} ", cell(&outcome)), outcome)
            };
            let (lower, higher) = (other(&cells[3]), other(&cells[4]));
            cells[5] = format!(
                " {} ",
                share(&left_out(&[&default, &lower.1, &higher.1]).into())
            );
            (cells[3], cells[4]) = (lower.0, higher.0);
            cells.join("|")
        });
        let made = lines.collect::<Vec<_>>().join("\n") + "\n";
        let said = format!(
            "find\n{} (the mean over the sets)",
            share(&default.mean(None).into())
        );
        assert!(
            made.contains(&said) && default.wrong == 0,
            "the defaults {}",
            cell(&default)
        );
        made
    });
}
