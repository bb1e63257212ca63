//! Settings that several nodes share, from one file, `--settings`, or from options.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::bail;
use clap::Parser as _;
use command_line::settings::{self, FIT_KEYS, READING_KEYS};
use dataflow::{Dataflow, Node};
use engine::beams::BeamConfig;
use engine::fit::FitConfig;
use engine::joined::JoinConfig;

use super::arguments::{ACCUMULATOR, TRACKER, value};

const PEAK_EXTRACTOR: &str = "peak_extractor";

/// Returns the value that a node is given for a setting; `None` if it has its default.
pub(crate) fn given(node: &Node, key: &str, folder: &Path) -> anyhow::Result<Option<String>> {
    Ok(all_given(node, folder)?.remove(key))
}

/// Returns the settings that a node is given: those of its options, which win, and of its file.
fn all_given(node: &Node, folder: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let mut given = match value(node, "--settings") {
        Some(file) => settings::read(&folder.join(file))?,
        None => BTreeMap::new(),
    };
    for key in READING_KEYS.into_iter().chain(FIT_KEYS) {
        let option = format!("--{}", key.replace('_', "-"));
        if let Some(value) = value(node, &option) {
            given.insert(key.to_owned(), value.to_owned());
        }
    }
    Ok(given)
}

/// Settings that nodes share, as each of them parses its own.
#[derive(Debug, PartialEq, clap::Parser)]
struct Shared {
    #[command(flatten)]
    join: JoinConfig,
    #[command(flatten)]
    beams: BeamConfig,
    #[command(flatten)]
    fit: FitConfig,
}

pub(crate) fn check(dataflow: &Dataflow, folder: &Path) -> anyhow::Result<()> {
    let Some(tracker) = dataflow.node(TRACKER) else {
        return Ok(());
    };
    let of_tracker = all_given(tracker, folder)?;
    for (executable, keys) in [
        (ACCUMULATOR, &READING_KEYS[..]),
        (PEAK_EXTRACTOR, &FIT_KEYS),
    ] {
        let Some(node) = dataflow.node(executable) else {
            continue;
        };
        let of_node = all_given(node, folder)?;
        for &key in keys {
            let values = [of_node.get(key), of_tracker.get(key)];
            let [here, there] = values.map(|value| parsed(key, value));
            // A value that is wrong is refused by its node.
            if here.zip(there).is_some_and(|(here, there)| here != there) {
                let said = |value: Option<&String>| match value {
                    Some(value) => format!("`{value}`"),
                    None => "the default".to_owned(),
                };
                bail!(
                    "nodes {} and {} have to read scans alike, but {key} is {} at the one and {} at \
                     the other: write it into a file, and give both --settings FILE",
                    node.id,
                    tracker.id,
                    said(values[0]),
                    said(values[1])
                );
            }
        }
    }
    Ok(())
}

/// Returns the settings of a node that is given this value alone; `None` if the value is wrong.
fn parsed(key: &str, value: Option<&String>) -> Option<Shared> {
    let option = value.map(|value| format!("--{}={value}", key.replace('_', "-")));
    Shared::try_parse_from(std::iter::once("node".to_owned()).chain(option)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;

    fn checked(accumulator: &str, peaks: &str, tracker: &str) -> Result<(), String> {
        let folder = tempfile::tempdir().unwrap();
        let settings = "max_beams: 90\nfit_sigma_m: 0.2\n";
        std::fs::write(folder.path().join("s.yaml"), settings).unwrap();
        let text = format!(
            "nodes:
  - {{id: p, path: bin/peak_extractor, args: \"{peaks}\"}}
  - {{id: a, path: bin/accumulator, args: \"{accumulator}\"}}
  - {{id: t, path: bin/tracker, args: \"{tracker}\"}}
"
        );
        check(&testing::parsed(&text), folder.path()).map_err(|error| error.to_string())
    }

    #[test]
    fn nodes_with_other_settings_than_the_tracker_are_refused_by_name() {
        const FILE: &str = "--settings s.yaml";
        for (accumulator, peaks, tracker) in [
            ("", "", ""),
            ("--max-beams 90 --headings 360", "", "--max-beams=90"),
            (FILE, "--settings=s.yaml", FILE),
            (FILE, "--fit-sigma-m 0.2", FILE),
            ("--max-beams 180 --deskew true", "--drawn-doubt 0.15", ""),
            ("--max-beams many", "", ""),
        ] {
            assert_eq!(checked(accumulator, peaks, tracker), Ok(()), "{tracker}");
        }
        let beams = "nodes a and t have to read scans alike, but max_beams is `90` at the one and \
                     the default at the other";
        let fit = "nodes p and t have to read scans alike, but fit_sigma_m is the default";
        for (accumulator, peaks, tracker, expected) in [
            ("--max-beams 90", "", "", beams),
            (FILE, FILE, "", "max_beams is `90`"),
            (FILE, "", FILE, fit),
            ("--settings none.yaml", "", "", "none.yaml"),
        ] {
            let error = checked(accumulator, peaks, tracker).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
    }
}
