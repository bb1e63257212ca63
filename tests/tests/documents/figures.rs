//! Figures in README and docs, compared by `backcast bench docs` with what the recordings give: the
//! shipped ones always, those of the evaluation data where they are.

use std::path::Path;

use tests::{evaluation_data, executables, root};

/// Compares the figures; the output of a failure names those that differ.
fn check(options: &[&Path]) {
    let mut command = executables::backcast();
    command
        .args(["bench", "docs", "--check", "--root"])
        .arg(root());
    let output = command.args(options).output().unwrap();
    assert!(
        output.status.success(),
        "{}{}`backcast bench docs` without --check writes the figures",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn figures_of_the_recordings_are_those_of_bench_docs() {
    match evaluation_data("documents figures of the evaluation data") {
        Some(data) => check(&[Path::new("--data"), data.parent().unwrap()]),
        None => check(&[]),
    }
}
