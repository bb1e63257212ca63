//! `backcast bench paper --quick` as a process, and `docs/paper.md` against what it
//! writes: each claim on the page has its row among the measured ones, with the same
//! verdict and about the same figure.

#![allow(
    clippy::unwrap_used,
    reason = "a test fails by panicking, helpers of tests too"
)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Times differ from machine to machine, and on a busy one from run to run: a verdict by
/// times is compared only where all its ratios are farther from their bounds than this
/// factor, and figures may differ by as much and more.
const CLEAR_MARGIN: f64 = 2.0;
/// By this much figures of times may differ from those on the page.
const TIMES_DIFFER: f64 = 10.0;
/// Counts, shares and errors are seeded; another processor may round some poses
/// otherwise.
const FIGURES_DIFFER: f64 = 1.3;

/// A row of a table, by the names of its columns.
type Row = BTreeMap<String, String>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn bench(options: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_backcast"))
        .args(["bench", "paper"])
        .args(options)
        .arg("--out")
        .arg(out)
        .current_dir(root())
        .output()
        .unwrap()
}

/// A table whose fields may be quoted.
fn read_csv(file: &Path) -> Vec<Row> {
    let text = fs::read_to_string(file).unwrap();
    let mut lines = text.lines().map(fields);
    let header = lines.next().unwrap();
    lines
        .map(|fields| header.iter().cloned().zip(fields).collect())
        .collect()
}

fn fields(line: &str) -> Vec<String> {
    let (mut all, mut field, mut is_quoted) = (Vec::new(), String::new(), false);
    for letter in line.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => all.push(std::mem::take(&mut field)),
            _ => field.push(letter),
        }
    }
    all.push(field);
    all
}

/// A row of the page: the claim's name, our figure and the verdict.
#[derive(Debug)]
struct OnPage {
    ours: String,
    verdict: String,
    command: String,
}

/// The rows of the page's tables of claims: `| id | claim | paper | ours | verdict |
/// command |`.
fn on_page(text: &str) -> BTreeMap<String, OnPage> {
    let rows = text.lines().filter(|line| line.starts_with("| "));
    let cells = rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect());
    let claims = cells.filter(|cells: &Vec<&str>| cells.len() == 6 && is_id(cells[0]));
    claims
        .map(|cells| {
            let row = OnPage {
                ours: cells[3].to_owned(),
                verdict: cells[4].to_owned(),
                command: cells[5].to_owned(),
            };
            (cells[0].to_owned(), row)
        })
        .collect()
}

fn is_id(cell: &str) -> bool {
    let mut letters = cell.chars();
    letters
        .next()
        .is_some_and(|letter| letter.is_ascii_uppercase())
        && letters.next().is_some_and(|letter| letter.is_ascii_digit())
        && letters.all(|letter| letter.is_ascii_digit())
}

/// The first number of a cell, per cent as a share.
fn number(cell: &str) -> f64 {
    let digits: String = cell
        .chars()
        .skip_while(|letter| !letter.is_ascii_digit())
        .take_while(|letter| letter.is_ascii_digit() || *letter == '.')
        .collect();
    digits
        .parse()
        .unwrap_or_else(|_| panic!("no number in {cell:?}"))
}

/// What on the page differs from a measured claim; empty where nothing does.
fn differences(id: &str, page: &OnPage, row: &Row) -> Vec<String> {
    let mut found = Vec::new();
    let is_time = row["basis"] == "time";
    let margin: f64 = row["margin"].parse().unwrap_or(f64::INFINITY);
    if page.verdict != row["verdict"] && (!is_time || margin > CLEAR_MARGIN) {
        found.push(format!(
            "{id}: the page says {:?}, measured is {:?}",
            page.verdict, row["verdict"]
        ));
    }
    let (said, measured) = (number(&page.ours), number(&row["ours"]));
    let allowed = if is_time {
        TIMES_DIFFER
    } else {
        FIGURES_DIFFER
    };
    let ratio = (said / measured).max(measured / said);
    if said != measured && ratio > allowed {
        found.push(format!(
            "{id}: the page says {said}, measured is {measured}"
        ));
    }
    found
}

#[test]
fn the_page_says_what_the_quick_run_measures() {
    let folder = TempDir::new().unwrap();
    let output = bench(&["--quick"], folder.path());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let page = fs::read_to_string(root().join("docs/paper.md")).unwrap();
    let rows = on_page(&page);
    let claims = read_csv(&folder.path().join("claims.csv"));
    let mut wrong = Vec::new();
    for row in &claims {
        match rows.get(&row["id"]) {
            Some(said) => wrong.extend(differences(&row["id"], said, row)),
            None => wrong.push(format!("{}: not on the page", row["id"])),
        }
    }
    for (id, said) in &rows {
        let is_measured = claims.iter().any(|row| &row["id"] == id);
        let by_bench = said.command.contains("backcast bench paper");
        if is_measured != by_bench {
            wrong.push(format!(
                "{id}: measured {is_measured}, but made by {}",
                said.command
            ));
        }
        if said.command.is_empty() {
            wrong.push(format!("{id}: no command"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    linked_files_are_made(&page, folder.path());
}

/// Every picture and table that the page links is one that the command makes, and is in
/// the repository.
fn linked_files_are_made(page: &str, folder: &Path) {
    let links = page.split("](paper/").skip(1);
    let names: Vec<&str> = links.filter_map(|rest| rest.split(')').next()).collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        assert!(folder.join(name).is_file(), "{name} is not made");
        assert!(
            root().join("docs/paper").join(name).is_file(),
            "{name} is not there"
        );
    }
}

#[test]
fn a_page_that_disagrees_is_noticed() {
    let row = |basis: &str, ours: &str, margin: &str, verdict: &str| -> Row {
        let pairs = [
            ("basis", basis),
            ("ours", ours),
            ("margin", margin),
            ("verdict", verdict),
        ];
        pairs
            .map(|(name, value)| (name.to_owned(), value.to_owned()))
            .into()
    };
    let page = |ours: &str, verdict: &str| OnPage {
        ours: ours.to_owned(),
        verdict: verdict.to_owned(),
        command: String::new(),
    };
    let differ = |page: &OnPage, row: &Row| differences("X1", page, row).len();
    assert_eq!(
        differ(
            &page("0.73", "holds"),
            &row("count", "0.7315", "1.4", "holds")
        ),
        0
    );
    assert_eq!(
        differ(
            &page("0.73", "in part"),
            &row("count", "0.7315", "1.4", "holds")
        ),
        1
    );
    assert_eq!(
        differ(
            &page("0.4", "holds"),
            &row("share", "0.7315", "1.4", "holds")
        ),
        1
    );
    assert_eq!(
        differ(
            &page("12 times", "holds"),
            &row("time", "30.0", "5", "does not hold")
        ),
        1
    );
    assert_eq!(
        differ(
            &page("12 times", "holds"),
            &row("time", "30.0", "1.5", "in part")
        ),
        0
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_anything_is_measured() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "no folder").unwrap();
    let output = bench(&["--quick"], &file.join("out"));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot write into the folder"), "{said}");
}

#[test]
fn options_of_other_tables_are_refused() {
    let run = |options: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_backcast"))
            .args(options.split(' '))
            .output()
            .unwrap();
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    for (options, says) in [
        ("bench paper --size 100", "`bench paper` takes"),
        ("bench paper --json", "`bench paper` takes"),
        ("bench table1 --quick --out here", "are for `bench paper`"),
        ("bench paper --part figure9", "invalid value"),
    ] {
        let (code, said) = run(options);
        assert_eq!(code, Some(2), "{options}: {said}");
        assert!(said.contains(says), "{options}: {said}");
    }
}
