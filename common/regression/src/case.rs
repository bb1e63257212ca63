//! Recordings that are replayed.

use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::wrong_use;

use super::answer::Answer;

/// A folder with a recording, its map and the expected results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Case {
    pub(super) name: String,
    /// Absolute path.
    folder: PathBuf,
}

impl Case {
    /// Returns the folder itself if it is a case, else all cases in it, sorted by name.
    ///
    /// # Errors
    /// It cannot be read, or contains no case.
    pub(super) fn all_in(folder: &Path) -> anyhow::Result<Vec<Self>> {
        let folder = std::path::absolute(folder).context("cannot find the current directory")?;
        if let Some(case) = Case::of(&folder) {
            return Ok(vec![case]);
        }
        let unreadable = || failed("read", &folder);
        let entries = std::fs::read_dir(&folder).with_context(unreadable)?;
        let paths: Vec<PathBuf> = entries
            .map(|entry| Ok(entry.with_context(unreadable)?.path()))
            .collect::<anyhow::Result<_>>()?;
        let mut cases: Vec<Case> = paths.iter().filter_map(|path| Case::of(path)).collect();
        cases.sort_by(|a, b| a.name.cmp(&b.name));
        match cases.is_empty() {
            true => Err(wrong_use(format!(
                "{} is not a folder with recording.mcap and map.yaml and contains none",
                folder.display()
            ))),
            false => Ok(cases),
        }
    }

    fn of(folder: &Path) -> Option<Self> {
        let case = Case {
            name: folder.file_name()?.to_string_lossy().into_owned(),
            folder: folder.to_owned(),
        };
        (case.recording().exists() && case.map().is_file()).then_some(case)
    }

    /// Path of the recording: a file, or the folder of a bag.
    pub(super) fn recording(&self) -> PathBuf {
        let names = ["recording.mcap", "recording", "recording.db3"];
        let mut paths = names.map(|name| self.folder.join(name)).into_iter();
        let found = paths.find(|path| path.exists());
        found.unwrap_or_else(|| self.folder.join("recording.mcap"))
    }

    pub(super) fn map(&self) -> PathBuf {
        self.folder.join("map.yaml")
    }

    fn expectation(&self) -> PathBuf {
        self.folder.join("expected.json")
    }

    /// Reads the expected results; `None` if the file does not exist.
    ///
    /// # Errors
    /// The file cannot be read, or has another format.
    pub(super) fn expected(&self) -> anyhow::Result<Option<Vec<Answer>>> {
        let file = self.expectation();
        let text = match std::fs::read_to_string(&file) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            read => read.with_context(|| failed("read", &file))?,
        };
        serde_json::from_str(&text).map(Some).with_context(|| {
            let file = file.display();
            format!("{file} does not say what is expected: --accept writes it again")
        })
    }

    /// Writes these results as the expected ones.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn accept(&self, answers: &[Answer]) -> anyhow::Result<()> {
        let file = self.expectation();
        // Strings and finite numbers always serialize.
        let text = serde_json::to_string_pretty(answers).unwrap_or_default() + "\n";
        std::fs::write(&file, text).with_context(|| failed("write", &file))
    }
}

pub(super) fn failed(action: &str, file: &Path) -> String {
    format!("cannot {action} {}", file.display())
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    #[test]
    fn a_case_has_a_recording_and_a_map() {
        let folder = TempDir::new().unwrap();
        let none = Case::all_in(folder.path()).unwrap_err();
        assert!(
            none.to_string()
                .contains("not a folder with recording.mcap"),
            "{none}"
        );
        for (name, files) in [
            ("b", &["recording.mcap", "map.yaml"][..]),
            ("a", &["recording.mcap", "map.yaml"]),
            ("c", &["recording.mcap"]),
        ] {
            let inner = folder.path().join(name);
            std::fs::create_dir(&inner).unwrap();
            for file in files {
                std::fs::write(inner.join(file), "").unwrap();
            }
        }
        let names = |folder: &Path| -> Vec<String> {
            let cases = Case::all_in(folder).unwrap();
            cases.into_iter().map(|case| case.name).collect()
        };
        assert_eq!(names(folder.path()), ["a", "b"]);
        assert_eq!(names(&folder.path().join("b")), ["b"]);
    }

    #[test]
    fn expectations_are_written_and_read_back() {
        let folder = TempDir::new().unwrap();
        for file in ["recording.mcap", "map.yaml"] {
            std::fs::write(folder.path().join(file), "").unwrap();
        }
        let case = Case::all_in(folder.path()).unwrap().remove(0);
        assert_eq!(case.expected().unwrap(), None);
        case.accept(&[Answer::default()]).unwrap();
        assert_eq!(case.expected().unwrap(), Some(vec![Answer::default()]));
        std::fs::write(folder.path().join("expected.json"), "[{}]").unwrap();
        let wrong = case.expected().unwrap_err();
        assert!(
            wrong.to_string().contains("--accept writes it again"),
            "{wrong}"
        );
    }
}
