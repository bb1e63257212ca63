//! Recordings that are replayed.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use command_line::{names, wrong_use};
use recording::Recording;
use schemars::JsonSchema;
use serde::Deserialize;

use super::answer::{Answer, Expected};

const RECORDING: &str = "recording.mcap";
const MAP: &str = "map.yaml";
const EXPECTATION: &str = "expected.json";

/// Version of the expectation's format: increased when a value changes its meaning.
const VERSION: u32 = 1;

/// Content of an expectation.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Expectation {
    Versioned {
        version: u32,
        #[schemars(with = "Vec<Answer>")]
        answers: Vec<Expected>,
    },
    /// As release 0.1.0 wrote it.
    #[schemars(skip)]
    Bare(Vec<Expected>),
}

/// A folder with a recording, the expected results, and its map unless the recording holds it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Case {
    pub(super) name: String,
    pub(super) folder: PathBuf,
}

/// Returns the cases of these folders: each folder itself if it is one, else all in it, sorted.
pub(super) fn all_in(folders: &[PathBuf]) -> anyhow::Result<Vec<Case>> {
    let mut found = Vec::new();
    for folder in folders {
        found.extend(cases_in(folder)?);
    }
    let names = names::of(&found).into_iter();
    let cases = names.zip(found);
    Ok(cases.map(|(name, folder)| Case { name, folder }).collect())
}

fn cases_in(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let folder = std::path::absolute(folder).context("cannot find the current directory")?;
    if recording_in(&folder).is_some() {
        return Ok(vec![folder]);
    }
    let unreadable = || failed("read", &folder);
    let mut cases = Vec::new();
    for entry in std::fs::read_dir(&folder).with_context(unreadable)? {
        let inner = entry.with_context(unreadable)?.path();
        let mut halves = [MAP, EXPECTATION].into_iter();
        if recording_in(&inner).is_some() {
            cases.push(inner);
        } else if let Some(found) = halves.find(|name| inner.join(name).exists()) {
            return Err(wrong_use(format!(
                "{} has {found}, but no recording.mcap, recording.db3 or folder recording",
                inner.display()
            )));
        }
    }
    cases.sort();
    match cases.is_empty() {
        true => Err(wrong_use(format!(
            "{} is not a folder with recording.mcap and contains none",
            folder.display()
        ))),
        false => Ok(cases),
    }
}

/// Returns the path of the recording of a case: a file, or the folder of a bag.
fn recording_in(folder: &Path) -> Option<PathBuf> {
    let names = [RECORDING, "recording", "recording.db3"];
    let mut paths = names.map(|name| folder.join(name)).into_iter();
    paths.find(|path| path.exists())
}

impl Case {
    /// Path of the recording: a file, or the folder of a bag.
    pub(super) fn recording(&self) -> PathBuf {
        recording_in(&self.folder).unwrap_or_else(|| self.folder.join(RECORDING))
    }

    /// Path of the map; `None` if it is to be taken from the recording.
    pub(super) fn map(&self) -> anyhow::Result<Option<PathBuf>> {
        let map = self.folder.join(MAP);
        if map.exists() {
            return Ok(Some(map));
        }
        match Recording::open(self.recording())?.maps()?.next() {
            Some(_) => Ok(None),
            None => bail!(
                "{} has no map.yaml, and its recording no map",
                self.folder.display()
            ),
        }
    }

    fn expectation(&self) -> PathBuf {
        self.folder.join(EXPECTATION)
    }

    /// Reads the expected results; `None` if the file does not exist.
    /// Fails if the file cannot be read, or has another format or a later version.
    pub(super) fn expected(&self) -> anyhow::Result<Option<Vec<Expected>>> {
        let file = self.expectation();
        let text = match std::fs::read_to_string(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            read => read.with_context(|| failed("read", &file))?,
        };
        let file = file.display();
        match serde_json::from_str(&text) {
            Ok(Expectation::Versioned { version, .. }) if version > VERSION => Err(anyhow!(
                "{file} has version {version}, and this release knows {VERSION}"
            )),
            Ok(Expectation::Versioned { answers, .. } | Expectation::Bare(answers)) => {
                Ok(Some(answers))
            }
            Err(_) => Err(anyhow!("{file} does not say what is expected")),
        }
    }

    pub(super) fn accept(&self, answers: &[Answer]) -> anyhow::Result<()> {
        let file = self.expectation();
        // Strings and finite numbers always serialize.
        let answers = serde_json::to_string_pretty(answers).unwrap_or_default();
        let text = format!("{{\"version\": {VERSION}, \"answers\": {answers}}}\n");
        std::fs::write(&file, text).with_context(|| failed("write", &file))
    }
}

fn failed(action: &str, file: &Path) -> String {
    format!("cannot {action} {}", file.display())
}

#[cfg(test)]
mod tests {
    use recording::write::{Packing, RecordingWriter};
    use tempfile::TempDir;

    use super::*;

    #[test]
    fn cases_have_names_of_their_own_and_half_a_case_is_an_error() {
        let folder = TempDir::new().unwrap();
        let none = all_in(&[folder.path().to_owned()]).unwrap_err();
        assert!(
            none.to_string()
                .contains("not a folder with recording.mcap"),
            "{none}"
        );
        for file in [
            "x/b/recording.mcap",
            "x/b/map.yaml",
            "x/a/recording.db3",
            "y/a/recording.mcap",
            "y/notes/map.txt",
            "z/c/expected.json",
        ] {
            let file = folder.path().join(file);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, "").unwrap();
        }
        let names = |folders: &[&str]| {
            let folders = folders.iter().map(|name| folder.path().join(name));
            let cases = all_in(&folders.collect::<Vec<_>>()).map_err(|error| error.to_string());
            cases.map(|cases| cases.into_iter().map(|case| case.name).collect::<Vec<_>>())
        };
        assert_eq!(names(&["x"]).unwrap(), ["a", "b"]);
        assert_eq!(names(&["x/b"]).unwrap(), ["b"]);
        assert_eq!(names(&["x", "y"]).unwrap(), ["x_a", "x_b", "y_a"]);
        let half = names(&["x", "z"]).unwrap_err();
        assert!(
            half.contains("z/c has expected.json, but no recording"),
            "{half}"
        );
    }

    #[test]
    fn the_map_is_that_of_the_folder_or_of_the_recording() {
        let corridor = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../recordings/malaga_corridor/recording.mcap"
        );
        let folder = TempDir::new().unwrap();
        let case = Case {
            name: "a".to_owned(),
            folder: folder.path().to_owned(),
        };
        std::fs::copy(corridor, case.recording()).unwrap();
        assert_eq!(case.map().unwrap(), None);
        let without = RecordingWriter::create(case.recording(), Packing::Plain).unwrap();
        without.finish().unwrap();
        let neither = case.map().unwrap_err().to_string();
        assert!(
            neither.ends_with("has no map.yaml, and its recording no map"),
            "{neither}"
        );
        std::fs::write(folder.path().join(MAP), "").unwrap();
        assert_eq!(case.map().unwrap(), Some(folder.path().join(MAP)));
    }

    #[test]
    fn expectations_are_read_back_of_each_version_that_is_known() {
        let folder = TempDir::new().unwrap();
        std::fs::write(folder.path().join(RECORDING), "").unwrap();
        let case = all_in(&[folder.path().to_owned()]).unwrap().remove(0);
        assert_eq!(case.expected().unwrap(), None);
        let answer = Answer {
            votes: 7,
            ..Answer::default()
        };
        case.accept(&[answer]).unwrap();
        let found = case.expected().unwrap().unwrap().remove(0);
        assert_eq!((found.stamp_ns, &found.values["votes"]), (0, &7.into()));
        let read = |text: &str| {
            std::fs::write(folder.path().join("expected.json"), text).unwrap();
            let expected = case.expected().map_err(|error| error.to_string());
            expected.map(|expected| expected.unwrap().remove(0).stamp_ns)
        };
        assert_eq!(read(r#"[{"stamp_ns": 5, "verdict": "Unique"}]"#), Ok(5));
        let later = r#"{"version": 1, "answers": [{"stamp_ns": 6, "new": {}}], "more": 0}"#;
        assert_eq!(read(later), Ok(6));
        let wrong = read(r#"{"version": 2, "answers": []}"#).unwrap_err();
        assert!(
            wrong.ends_with("has version 2, and this release knows 1"),
            "{wrong}"
        );
        let wrong = read("[{}]").unwrap_err();
        assert!(wrong.ends_with("does not say what is expected"), "{wrong}");
    }
}
