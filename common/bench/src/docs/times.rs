//! Times, measured one recording at a time, with the machine and the commit on each page that has
//! some.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};
use engine::instruction_set::InstructionSet;

use super::marks::{Figures, Place, Written};
use super::recordings::{Folders, QUERIES, SHIPPED};
use super::runs::Runs;
use super::tables::{SHIPPED_TIMES, TIMES};

/// Marks that hold machine and commit.
pub(super) const PLACES: [Place; 2] = [("README.md", "machine"), ("docs/accuracy.md", "machine")];

pub(super) fn measure(root: &Path, folders: &Folders) -> anyhow::Result<Vec<Written>> {
    let mut runs = Runs::default();
    let shipped = folders.shipped().map(|file| runs.evaluate(&[], &[file]));
    let data = folders
        .data
        .iter()
        .flat_map(|data| QUERIES.map(|(_, file)| data.join(file)));
    let queries: Vec<_> = data.map(|file| runs.evaluate(&[], &[file])).collect();
    let found = runs.run(1)?;
    let row = |&((name, _), run): &((&str, &str), usize)| (name.to_owned(), found[run][0].clone());
    let rows: Vec<_> = SHIPPED.into_iter().zip(shipped).collect();
    let mut written = vec![SHIPPED_TIMES.of(&rows.iter().map(row).collect::<Vec<_>>())];
    let machine = Figures::Value(format!("{}, {}", machine()?, commit(root)?));
    let rows: Vec<_> = QUERIES.into_iter().zip(queries).collect();
    let mut pages = &PLACES[..1];
    if !rows.is_empty() {
        written.push(TIMES.of(&rows.iter().map(row).collect::<Vec<_>>()));
        pages = &PLACES;
    }
    written.extend(pages.iter().map(|&place| Written {
        place,
        figures: machine.clone(),
    }));
    Ok(written)
}

/// Processor, and the instructions that the search uses there.
fn machine() -> anyhow::Result<String> {
    const FILE: &str = "/proc/cpuinfo";
    let text = std::fs::read_to_string(FILE).with_context(|| format!("cannot read {FILE}"))?;
    let model = text
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    let model = model.map_or("unknown processor", |model| {
        model.trim_start_matches([' ', '\t', ':'])
    });
    Ok(format!("{model} with {}", InstructionSet::best()))
}

/// Commit of the checkout, and its date.
fn commit(root: &Path) -> anyhow::Result<String> {
    let mut git = Command::new("git");
    git.arg("-C")
        .arg(root)
        .args(["show", "--no-patch", "--format=%cs, commit %h"]);
    let output = git.output().context("cannot run git for the commit")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(
        output.status.success(),
        "git does not say the commit: {}",
        said.trim()
    );
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
