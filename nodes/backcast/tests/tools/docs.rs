//! `backcast bench docs` as a process, on a checkout whose recordings are others than the pages say,
//! and options of `bench`.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::drawn::{assert_refused, recordings, run};

/// Creates a checkout with the pages of this one, and the shortest recording in place of all three.
fn checkout() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let from = recordings().parent().unwrap().to_owned();
    fs::copy(from.join("README.md"), root.path().join("README.md")).unwrap();
    fs::create_dir(root.path().join("docs")).unwrap();
    for page in fs::read_dir(from.join("docs")).unwrap() {
        let page = page.unwrap();
        if page.file_type().unwrap().is_file() {
            fs::copy(page.path(), root.path().join("docs").join(page.file_name())).unwrap();
        }
    }
    for name in ["malaga_corridor", "malaga_courtyard", "malaga_campus"] {
        let folder = root.path().join("recordings").join(name);
        fs::create_dir_all(&folder).unwrap();
        let recording = recordings().join("malaga_corridor/recording.mcap");
        fs::copy(recording, folder.join("recording.mcap")).unwrap();
    }
    root
}

fn pages(root: &Path) -> Vec<String> {
    let pages = [
        "README.md",
        "docs/accuracy.md",
        "docs/benchmark.md",
        "docs/tracking.md",
    ];
    let read = |page| fs::read_to_string(root.join(page)).unwrap();
    pages.map(read).to_vec()
}

#[test]
fn figures_of_other_recordings_are_named_and_not_written() {
    let root = checkout();
    let before = pages(root.path());
    let (code, stdout, stderr) = run(root.path(), "bench docs --check");
    assert_eq!(code, 1, "{stdout}{stderr}");
    let expected =
        "README.md: scans, malaga_campus, column \"truths\": \"220\" on the page, \"37\" measured";
    assert!(stdout.lines().any(|line| line == expected), "{stdout}");
    assert!(!stdout.contains("malaga_corridor"), "{stdout}");
    assert_eq!(pages(root.path()), before);
}

#[test]
fn wrong_folders_and_options_are_refused() {
    let root = checkout();
    let no_checkout = "recordings has no README.md: needed is a checkout";
    let no_data = "there is no recordings/evaluation/intel_queries.mcap: --data";
    let (docs, paper) = ("`bench docs` takes --root, --data,", "`bench paper` takes");
    for (options, expected) in [
        ("docs --root recordings", no_checkout),
        ("docs --data recordings", no_data),
        ("docs --constants", "--data"),
        ("docs --check --times", "cannot be used with"),
        ("docs --quick", docs),
        ("docs --json", docs),
        ("docs --out there", docs),
        ("paper --size 100", paper),
        ("paper --json", paper),
        ("paper --part figure9", "invalid value"),
        ("table1 --check", "are for `bench docs`, not for table1"),
        ("table1 --quick --out here", "are for `bench paper`"),
    ] {
        assert_refused(root.path(), &format!("bench {options}"), 2, expected);
    }
}
